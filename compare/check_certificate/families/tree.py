"""A search tree of boxes, replayed event by event."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import BadInput, Refused, need
from compare.check_certificate.balls import least, most
from compare.check_certificate.claim import MOST_SEGMENTS, Claim
from compare.check_certificate.reading import index, items, number


class Node:
    """A box of the tree.

    box: ends [lo, hi] per variable; hi is None where there is no upper end. known: what a family knows
    on it beside. empty: whether the box is known to hold no motion.
    """

    def __init__(self, box: list[list[Any]], known: Any = None, empty: bool = False) -> None:
        self.box, self.known, self.empty = [list(ends) for ends in box], known, empty
        self.reference: Any = None
        self.form: tuple[Any, Any] = (None, None)

    def half(self, k: int, end: int, value: Any) -> Node:
        """Make the same box with one end moved.

        Parameters
        ----------
        k, end : int
            The variable, and 0 for its lower end or 1 for its upper one.
        value : arb
            The new end.

        Returns
        -------
        Node
            A box of its own.
        """
        child = Node(self.box, self.known, self.empty)
        child.box[k][end] = value
        return child


class Tree:
    """Replays the events; a family adds its domain, its sums of conditions and what a turn does."""

    claim: Claim
    root: Node

    def _excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """Lower bound of the weighted sum of conditions over a box within the node's."""
        raise NotImplementedError

    def _turn(self, node: Node) -> None:
        """Narrow a node by what its box implies."""
        raise Refused("an event this family does not have")

    def _velocity_halves(self, event: list[Any], node: Node) -> list[Node]:
        """Split what is known of a velocity."""
        raise Refused("an event this family does not have")

    def replay(self) -> int:
        """Verify every event; returns the number of discards."""
        return self._replay_tree(self.claim.events, 1, 0)

    def _replay_tree(self, events: list[Any], begin: int, offset: int) -> int:
        """Verify one tree, whose events count from ``begin`` and its variables from ``offset``."""
        stack, discards = [self.root], 0
        rows: list[Any] = []  # those of the last event that has some; none prove nothing
        node: Node | None = None
        for count, raw in enumerate(events, begin):
            event = items(raw, 1, 4)
            letter, where = str(event[0]), f"event {count}"
            if node is None:
                need(stack, f"{where}: every box has ended")
                node = stack.pop()
            has_rows = len(event) == {"L": 2, "B": 4, "A": 4}.get(letter, 0)
            if has_rows:
                rows = [self.claim.row(row) for row in items(event[-1], 0, MOST_SEGMENTS + 1)]
            if letter in ("B", "A", "S"):
                items(event, 3, 4)
                k, value = index(event[1], offset + len(node.box)) - offset, number(event[2])
                need(k >= 0, f"{where}: the segment is not in the part")
                lo, hi = node.box[k]
            if letter == "T":
                if not node.empty:
                    self._turn(node)
            elif letter == "E":
                need(node.empty, f"{where}: something is left of the box")
                node = None
            elif letter == "L":
                need(
                    node.empty or self._excess(rows, node, node.box) > 0,
                    f"{where}: the box is not discarded",
                )
                discards += 1
                node = None
            elif letter in ("B", "A"):
                if node.empty:
                    continue
                need(hi is not None, f"{where}: the box has no such end")
                slab = [value, hi] if letter == "B" else [lo, value]
                slab = [most(slab[0], lo), least(slab[1], hi)]
                if not slab[0] > slab[1]:
                    box = [slab if i == k else ends for i, ends in enumerate(node.box)]
                    need(self._excess(rows, node, box) > 0, f"{where}: the slab is not discarded")
                    discards += 1
                    # the closed slab is gone
                    node.empty = bool(value <= lo if letter == "B" else value >= hi)
                    node.box[k] = [lo, slab[0]] if letter == "B" else [slab[1], hi]
            elif letter == "S":
                if not node.empty:
                    need(
                        lo < value and (hi is None or value < hi),
                        f"{where}: the split is outside the box",
                    )
                stack += [node.half(k, 1, value), node.half(k, 0, value)]
                node = None
            elif letter == "V":
                stack += self._velocity_halves(event, node)
                node = None
            else:
                raise BadInput(f"{where}: unknown event {letter!r:.20}")
        need(node is None and not stack, "the events end before every box has ended")
        return discards
