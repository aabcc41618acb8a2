"""The directive ``timebound-commands``: every command of a group, as ``timebound NAME --help`` shows it."""

from __future__ import annotations

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from compare.__main__ import application
from compare.commands import COMMANDS, Command


class CommandsDirective(SphinxDirective):
    """A section per command of the group that the argument names."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """Make the sections.

        Returns
        -------
        list of Node
        """
        group = [command for command in COMMANDS.values() if command.group == self.arguments[0]]
        if not group:
            raise self.error(f"no command is in the group {self.arguments[0]!r}")
        found: list[nodes.Node] = []
        for command in group:
            section = nodes.section(ids=[f"timebound-{command.name}"], names=[command.name])
            section += nodes.title(text=command.name)
            section += self.parse_text_to_nodes(_markdown(command))
            found.append(section)
        return found


def _markdown(command: Command) -> str:
    """Usage, docstring and options of a command, as its own help has them, then its example."""
    from cyclopts.docs.markdown import generate_markdown_docs

    text = generate_markdown_docs(
        application(command.name), commands_filter=[command.name], no_root_title=True
    )
    return f"{text}\n\nExample:\n\n```sh\n{command.example}\n```\n"
