"""Results that survive: the store of a run, the cache of parts, tables. SQLite only here."""
