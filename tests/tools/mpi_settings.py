"""What mpirun must be told on a test machine: root may run it, and ranks may outnumber cores."""

# As variables, because every MPI has other options for it (OMPI: Open MPI 4; PRTE: Open MPI 5; MPICH needs none).
MPI_SETTINGS = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_orte_execute_quiet": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}
