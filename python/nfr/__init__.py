"""fontTools knows the table `Nfrt` after `import nfr`: its subsetter keeps and renumbers it, and `ttx` writes and reads it."""

from fontTools.ttLib import registerCustomTableClass

registerCustomTableClass("Nfrt", "nfr.table", "table_N__f_r_t")
