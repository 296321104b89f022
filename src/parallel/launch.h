/* How a process was started. */
#ifndef KAPITZA_PARALLEL_LAUNCH_H
#define KAPITZA_PARALLEL_LAUNCH_H

/* Before MPI_Init: where no launcher started this process, Open MPI starts no daemon beside it and looks for no network, which takes two thirds of
 * the time of its start. Settings of the user stay. Processes of a launcher that leaves no sign are each alone, as they would be without
 * this; the lock of the checkpoint then lets one of them write. */
void kz_launch_alone(void);

#endif
