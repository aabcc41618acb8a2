"""What a store keeps beside the runs: what was asked for, bounds, known times, instances, audits."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord, checked_ladder_record
from compare.benchmark.records.database import documents
from compare.benchmark.records.database.connection import Database
from compare.benchmark.records.proof_cache import ProofKey
from compare.benchmark.records.settings import Settings
from formulations import InputError


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
        found = self._documents("settings")
        if not found:
            raise InputError(f"{self.folder}: holds no comparison")
        try:
            return Settings.from_json(found[""])
        except ValueError as error:
            raise InputError(f"{self.file}: {error}") from None

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
        found = self._documents("ladder")
        return {case: checked_ladder_record(data, self.file) for case, data in found.items()}

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
        try:
            return {
                case: [KnownTime(**line) for line in lines]
                for case, lines in self._documents("known times").items()
            }
        except TypeError as error:
            raise InputError(f"{self.file}: not a table of known times: {error}") from None

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
        return self._documents("instance")

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
        return self._documents("audit")

    @contextmanager
    def _reading(self) -> Iterator[sqlite3.Connection]:
        """The connection; a value that does not fit becomes one line."""
        with self.database.reading() as connection:
            try:
                yield connection
            except ValueError as error:
                raise InputError(f"{self.file}: {error}") from None

    def _documents(self, kind: str) -> dict[str, Any]:
        if not self.database.exists():
            return {}
        with self._reading() as connection:
            return documents.documents(connection, kind)

    def _write(self, kind: str, name: str, data: Any) -> None:
        with self.database.writing() as connection:
            documents.write_document(connection, kind, name, data)
