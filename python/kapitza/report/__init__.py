"""The report: one self-contained page on a result, to be read without a server (`kapitza plot report FILE`)."""
