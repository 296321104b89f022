/* MPI for the library, which is one process: this layer compiles without an MPI, and none of these functions is called,
 * because nobody starts it (kz_ranks_several). */
#pragma once

#include <string.h>

typedef int MPI_Comm, MPI_Request;
typedef struct {
  int MPI_SOURCE;
} MPI_Status;

enum { MPI_SUCCESS = 0, MPI_ERR_OTHER = 15, MPI_UNDEFINED = -32766, MPI_ANY_SOURCE = -1 };
enum { MPI_MAX_ERROR_STRING = 256, MPI_MAX_LIBRARY_VERSION_STRING = 64 };
enum { MPI_COMM_NULL, MPI_COMM_WORLD, MPI_REQUEST_NULL = 0, MPI_INFO_NULL = 0, MPI_ERRORS_RETURN = 0 };
enum { MPI_BYTE, MPI_DOUBLE, MPI_2INT, MPI_INT64_T, MPI_SUM, MPI_MAX, MPI_MAXLOC };
enum { MPI_THREAD_SINGLE, MPI_THREAD_SERIALIZED = 2, MPI_COMM_TYPE_SHARED = 1 };
#define MPI_STATUS_IGNORE ((MPI_Status *)0)
#define MPI_STATUSES_IGNORE ((MPI_Status *)0)
#define MPI_IN_PLACE ((void *)1)

/* Fails, whatever a function is given. */
static inline int kz_mpi_missing(int first, ...) {
  (void)first;
  return MPI_ERR_OTHER;
}
#define MPI_Abort(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Allreduce(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Bcast(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Cancel(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_dup(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_free(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_rank(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_set_errhandler(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_size(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Comm_split_type(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Error_string(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Finalize() kz_mpi_missing(0)
#define MPI_Finalized(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Get_count(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Get_library_version(text, length) (strcpy(text, "none"), (void)(length), MPI_SUCCESS)
#define MPI_Init_thread(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Initialized(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Irecv(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Isend(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Recv(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Reduce(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Send(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Test(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Testall(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Testany(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Wait(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Waitall(...) kz_mpi_missing(0, __VA_ARGS__)
#define MPI_Waitany(...) kz_mpi_missing(0, __VA_ARGS__)
