/* Measures what messages cost, for benchmarks/scaling.py: mpirun -n 2 messages ROUNDS
 *
 * Printed as JSON, in seconds: `message`, one way; `answer`, what rank 0 needs for a request that is there (as
 * src/parallel/dispatch.c answers it); and `bandwidth`, bytes a second of a broadcast; each the
 * lowest tenth of ROUNDS. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

enum { ASK = 1, ANSWER = 2, ASK_BYTES = 16, ANSWER_BYTES = 24, BLOCK = 1 << 23, BURST = 64 };

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Time below which one of ten rounds stays: other work on the machine makes the rest longer. */
static double messages_decile(double *list, int n) {
  qsort(list, (size_t)n, sizeof *list, by_size);
  return list[n / 10];
}

static void answer_one(char *buffer) {
  MPI_Status from;
  MPI_Recv(buffer, ASK_BYTES, MPI_BYTE, MPI_ANY_SOURCE, ASK, MPI_COMM_WORLD, &from);
  MPI_Send(buffer, ANSWER_BYTES, MPI_BYTE, from.MPI_SOURCE, ANSWER, MPI_COMM_WORLD);
}

/* Rank 1 asks and waits: half of that is one way. */
static double time_message(int rank, char *buffer) {
  const double begun = MPI_Wtime();
  if (rank == 0) {
    answer_one(buffer);
  } else if (rank == 1) {
    MPI_Send(buffer, ASK_BYTES, MPI_BYTE, 0, ASK, MPI_COMM_WORLD);
    MPI_Recv(buffer, ANSWER_BYTES, MPI_BYTE, 0, ANSWER, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  return (MPI_Wtime() - begun) / 2;
}

/* Rank 0 answers requests that have all come. */
static double time_answer(int rank, char *buffer) {
  MPI_Request request[BURST];
  if (rank == 1) {
    for (int i = 0; i < BURST; i++)
      MPI_Irecv(buffer + i * ANSWER_BYTES, ANSWER_BYTES, MPI_BYTE, 0, ANSWER, MPI_COMM_WORLD, &request[i]);
    for (int i = 0; i < BURST; i++) MPI_Send(buffer, ASK_BYTES, MPI_BYTE, 0, ASK, MPI_COMM_WORLD);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const double begun = MPI_Wtime();
  for (int i = 0; rank == 0 && i < BURST; i++) answer_one(buffer);
  const double seconds = (MPI_Wtime() - begun) / BURST;
  if (rank == 1) MPI_Waitall(BURST, request, MPI_STATUSES_IGNORE);
  return seconds;
}

static double time_block(int rank, char *buffer) {
  MPI_Barrier(MPI_COMM_WORLD);
  const double begun = MPI_Wtime();
  MPI_Bcast(buffer, BLOCK, MPI_BYTE, 0, MPI_COMM_WORLD);
  if (rank == 1) MPI_Send(NULL, 0, MPI_BYTE, 0, ASK, MPI_COMM_WORLD);
  if (rank == 0) MPI_Recv(NULL, 0, MPI_BYTE, 1, ASK, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return MPI_Wtime() - begun;
}

int main(int n, char **words) {
  MPI_Init(&n, &words);
  const int rounds = n == 2 ? atoi(words[1]) : 0;
  int rank, size;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  char *buffer = calloc(BLOCK, 1);
  double *message = calloc(3 * (size_t)rounds + 1, sizeof *message), *answer = message + rounds,
         *block = answer + rounds;
  if (rounds < 1 || size < 2 || !buffer || !message) {
    if (rank == 0) fputs("usage: mpirun -n 2 messages ROUNDS\n", stderr);
    MPI_Finalize();
    return 2;
  }
  for (int i = 0; i < rounds; i++) message[i] = time_message(rank, buffer);
  for (int i = 0; i < rounds; i++) answer[i] = time_answer(rank, buffer);
  for (int i = 0; i < rounds; i++) block[i] = time_block(rank, buffer);
  if (rank == 0)
    printf("{\"message\": %.3g, \"answer\": %.3g, \"bandwidth\": %.3g}\n", messages_decile(message, rounds),
           messages_decile(answer, rounds), BLOCK / messages_decile(block, rounds));
  free(message);
  free(buffer);
  MPI_Finalize();
  return 0;
}
