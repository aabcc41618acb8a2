"""What a store keeps beside the runs: what was asked for, bounds, known times, instances, audits."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any, NotRequired, TypedDict, cast

from compare.audit.judged import JudgedTimes
from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.database import documents
from compare.benchmark.records.database.connection import Database
from compare.benchmark.records.proof_cache import ProofKey
from compare.benchmark.records.settings import Settings
from compare.plain_data import parse_json, typed_or_line
from formulations import InputError


class FindingRecord(TypedDict):
    """A finding of an audit, as `compare.audit` writes it."""

    kind: str
    meaning: str
    fault: bool
    proved: bool
    where: str
    text: str


class HintRecord(TypedDict):
    """A hint of an audit: a change that would explain some of its faults."""

    question: str
    text: str


class AuditedPaper(TypedDict):
    """The audit of one paper, or of one variant of it."""

    paper: str
    title: str
    source: str
    notes: str
    unit: str
    motions: list[dict[str, Any]]  # JudgedTimes as plain data
    findings: list[FindingRecord]
    hints: NotRequired[list[HintRecord]]  # earlier versions wrote none


class AuditRecord(TypedDict):
    """The audits of a paper and its variants, and what they were made of."""

    digest: str
    versions: str
    machine: str
    audits: list[AuditedPaper]


def require_judged(record: AuditRecord, where: str) -> None:
    """Make sure that the motions of an audit are `JudgedTimes` as plain data.

    Parameters
    ----------
    record : AuditRecord
    where : str
        Start of the message.

    Raises
    ------
    InputError
        One is not; the message names the entry.
    """
    for audit in record["audits"]:
        typed_or_line(list[JudgedTimes], audit["motions"], where)


class StoredFacts:
    """What ``DIR/results.sqlite`` holds beside the runs.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.file = folder / "results.sqlite"
        self.database = Database(self.file)

    def close(self) -> None:
        """Close the file; the next use opens it again."""
        self.database.close()

    def write_settings(self, settings: Settings) -> None:
        """Keep what was asked for.

        Parameters
        ----------
        settings : Settings
        """
        self._write("settings", "", asdict(settings))

    def settings(self) -> Settings:
        """What was asked for. Raises InputError if the folder holds no comparison."""
        found = self._documents("settings", Settings)
        if not found:
            raise InputError(f"{self.folder}: holds no comparison")
        (settings,) = found.values()
        return cast(Settings, settings)

    def write_ladder(self, case: str, ladder: LadderRecord) -> None:
        """Keep the bounds of a case.

        Parameters
        ----------
        case : str
        ladder : LadderRecord
        """
        self._write("ladder", case, ladder)

    def ladders(self) -> dict[str, LadderRecord]:
        """Bounds by case, in alphabetical order."""
        return self._documents("ladder", LadderRecord)

    def write_proof(self, key: ProofKey, data: Any) -> None:
        """Keep what was proved, for later comparisons in this folder and in those it is merged into.

        Parameters
        ----------
        key : ProofKey
            What it depends on.
        data : Any
            Ready for strict JSON.
        """
        with self.database.writing() as connection:
            documents.write_proof(connection, key, data)

    def proved(self, key: ProofKey) -> Any:
        """Return what was proved before, by the same code for the same problem.

        Parameters
        ----------
        key : ProofKey

        Returns
        -------
        Any
            None if nothing was.
        """
        if not self.database.exists():
            return None
        with self._reading() as connection:
            return documents.proof(connection, key)

    def write_known_times(self, case: str, lines: list[KnownTime]) -> None:
        """Keep what is known of the task of a case.

        Parameters
        ----------
        case : str
        lines : list of KnownTime
        """
        self._write("known times", case, [asdict(line) for line in lines])

    def known_times(self) -> dict[str, list[KnownTime]]:
        """What is known of the task of each case."""
        return self._documents("known times", list[KnownTime])

    def write_instance(self, name: str, data: dict[str, Any]) -> None:
        """Keep what is known of an instance, as plain data.

        Parameters
        ----------
        name : str
        data : dict
            Ready for strict JSON.
        """
        self._write("instance", name, data)

    def instances(self) -> dict[str, dict[str, Any]]:
        """Instances by name, as plain data."""
        return self._documents("instance", dict[str, Any])

    def write_audit(self, paper: str, made_of: Mapping[str, str], audits: list[dict[str, Any]]) -> None:
        """Keep the audits of a paper and its variants.

        Parameters
        ----------
        paper : str
        made_of : mapping of str to str
            Digest of the paper's text, versions and machine.
        audits : list of dict
            As `compare.audit.Audit.to_json` gives them.
        """
        self._write("audit", paper, {**made_of, "audits": audits})

    def audits(self) -> dict[str, dict[str, Any]]:
        """By paper: what its audit was made of, and ``audits``, a list."""
        found = self._documents("audit", AuditRecord)
        for name, record in found.items():
            require_judged(record, f"{self.file}: audit {name}")
        return found

    @contextmanager
    def _reading(self) -> Iterator[sqlite3.Connection]:
        """The connection; a value that does not fit, or one that is missing, becomes one line."""
        with self.database.reading() as connection:
            try:
                yield connection
            except ValueError as error:
                raise InputError(f"{self.file}: {error}") from None
            # SQLite keeps any type in any column, and a damaged file has rows that refer to none
            except (KeyError, TypeError, OverflowError) as error:
                raise InputError(f"{self.file}: damaged: {error!r:.200}") from None

    def _documents(self, what: str, kind: Any) -> dict[str, Any]:
        """Documents of one kind by name, each entry of the type that it must have."""
        if not self.database.exists():
            return {}
        with self._reading() as connection:
            texts = documents.documents(connection, what)
        where = f"{self.file}: {what}"
        return {
            name: parse_json(text, kind, f"{where} {name}".rstrip()) for name, text in texts.items()
        }

    def _write(self, kind: str, name: str, data: Any) -> None:
        with self.database.writing() as connection:
            documents.write_document(connection, kind, name, data)
