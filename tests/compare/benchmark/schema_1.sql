-- the tables of a store of version 1
CREATE TABLE makers (
  id INTEGER PRIMARY KEY,
  digest TEXT NOT NULL UNIQUE,
  "case" TEXT NOT NULL,
  "family" TEXT NOT NULL,
  "coding" TEXT NOT NULL,
  "swarm" TEXT NOT NULL,
  "library" TEXT NOT NULL,
  "parameters" TEXT NOT NULL,
  "code" TEXT NOT NULL,
  "budget" INTEGER NOT NULL,
  "population" INTEGER NOT NULL,
  "isolated" INTEGER NOT NULL,
  "time_limit" REAL,
  "problem" TEXT NOT NULL,
  "versions" TEXT NOT NULL
) STRICT;
CREATE TABLE machines (id INTEGER PRIMARY KEY, machine TEXT NOT NULL UNIQUE) STRICT;
CREATE TABLE runs (
  id INTEGER PRIMARY KEY,
  maker INTEGER NOT NULL REFERENCES makers (id),
  seed INTEGER NOT NULL,
  machine INTEGER NOT NULL REFERENCES machines (id),
  "status" TEXT NOT NULL,
  "claimed" REAL,
  "keeps_limits" INTEGER,
  "stretch" REAL,
  "seconds" REAL,
  "bound" REAL,
  "proof" TEXT NOT NULL,
  "gap" REAL,
  "claimed_gap" REAL,
  "evaluations" INTEGER NOT NULL,
  "durations" BLOB NOT NULL,
  "worst" TEXT NOT NULL,
  "note" TEXT NOT NULL,
  "seconds_algorithm" REAL NOT NULL,
  "seconds_objective" REAL NOT NULL,
  UNIQUE (maker, seed)
) STRICT;
CREATE TABLE traces (run INTEGER PRIMARY KEY REFERENCES runs (id), data BLOB NOT NULL) STRICT;
CREATE TABLE instances (
  problem TEXT NOT NULL, name TEXT NOT NULL, data TEXT NOT NULL, PRIMARY KEY (problem, name)
) STRICT;
CREATE TABLE plans (id INTEGER PRIMARY KEY, digest TEXT NOT NULL UNIQUE, used INTEGER NOT NULL) STRICT;
CREATE TABLE planned (
  plan INTEGER NOT NULL REFERENCES plans (id),
  place INTEGER NOT NULL,
  maker INTEGER NOT NULL REFERENCES makers (id),
  seed INTEGER NOT NULL,
  PRIMARY KEY (plan, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE proofs (
  problem TEXT NOT NULL, versions TEXT NOT NULL, code TEXT NOT NULL, certified INTEGER NOT NULL,
  data TEXT NOT NULL, PRIMARY KEY (problem, versions, code, certified)
) STRICT;
CREATE TABLE documents (
  kind TEXT NOT NULL, name TEXT NOT NULL, data TEXT NOT NULL, PRIMARY KEY (kind, name)
) STRICT;
CREATE VIEW rows AS SELECT m."case", m."family", m."coding", m."swarm", m."library", m."parameters", m."code", r."seed", r."status", r."claimed", r."keeps_limits", r."stretch", r."seconds", r."bound", r."proof", r."gap", r."claimed_gap", m."budget", m."population", r."evaluations", r."durations", r."worst", r."note", m."isolated", m."time_limit", r."seconds_algorithm", r."seconds_objective", m."problem", m."versions", c."machine" FROM runs r JOIN makers m ON m.id = r.maker JOIN machines c ON c.id = r.machine;
