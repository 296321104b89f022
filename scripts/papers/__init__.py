"""Every number of the two papers, found anew by the program: docs/validation/results.md (`scripts/reproduce`)."""
