"""Every number of the two papers, found anew by the program: docs/results.md (`scripts/reproduce`)."""
