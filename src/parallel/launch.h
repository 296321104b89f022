/* How a process was started. */
#ifndef KAPITZA_PARALLEL_LAUNCH_H
#define KAPITZA_PARALLEL_LAUNCH_H

/* Call it before MPI_Init. If no launcher has started this process, it keeps Open MPI from starting a daemon and from looking for networks,
 * which takes two thirds of its start. Settings of the user stay. Processes of a launcher that cannot be recognised run alone, with and
 * without this call; the lock of the checkpoint then lets one of them write. */
void kz_launch_alone(void);

#endif
