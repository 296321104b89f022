/* The entry, compiled for its processor's first instruction set: checks the CPU before any newer code runs. */
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app.h"

/* Fills closed standard streams with /dev/null, opened so that using them fails: else a file opened later would take
 * the place of one and receive what the program prints. */
static void fill_streams(void) {
  static const int modes[] = {O_WRONLY, O_RDONLY, O_RDONLY};
  for (int stream = 0; stream < 3; stream++)
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", modes[stream]) == -1) _exit(KZ_FAILED);
}

/* Half of this is what the deepest calls need, MPI and HDF5 included. */
static const rlim_t STACK_BYTES = 512 << 10;

/* The least number of open files: streams, the scene, the result, the checkpoint, and what MPI opens. */
static const rlim_t FILES = 32;

/* Says how a limit of this process must be raised, once for all ranks. */
static kz_status refuse_limit(const char *what, const char *option, int least) {
  if (kz_launch_rank() <= 0)
    fprintf(stderr, "kapitza: error: %s limited to less than %d; ulimit %s %d\n", what, least, option, least);
  return KZ_REFUSED;
}

static bool has_files(void) {
  struct rlimit files;
  return getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= FILES;
}

static bool has_stack(void) {
  struct rlimit stack;
  return getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= STACK_BYTES;
}

int main(int argc, char **argv) {
  fill_streams();
  const char *missing = kz_missing_instruction();
  if (missing) {
    fprintf(stderr,
            "kapitza: error: this program was built for %s, which this CPU lacks; build it with "
            "-DKAPITZA_ARCH=" KZ_FIRST_INSTRUCTIONS "\n",
            missing);
    return KZ_REFUSED;
  }
  if (!has_stack()) return refuse_limit("the kilobytes of the stack are", "-s", (int)(STACK_BYTES >> 10));
  if (!has_files()) return refuse_limit("the files that may be open at once are", "-n", (int)FILES);
  kz_abandon_arm();
  const kz_status status = kz_message_print(kz_app(argc, argv));
  kz_abandon_disarm();
  return status;
}
