/* The fsync of a slow disk, linked into a test, or loaded ahead of libc by LD_PRELOAD: waits for as many seconds as the
   file says that the environment variable SLOW_FSYNC names. The file is read over and over, so that whoever waits can be
   released; without it nobody waits. */

#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static double delay(void) {
  const char* path = getenv("SLOW_FSYNC");
  FILE* file = path ? fopen(path, "re") : NULL;
  double seconds = 0;
  if (!file) return 0;
  if (fscanf(file, "%lf", &seconds) != 1) seconds = 0;
  fclose(file);
  return seconds;
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int fsync(int fd) {
  const struct timespec step = {0, 5000000};
  const double begin = now();
  while (now() - begin < delay()) nanosleep(&step, NULL);
  return (int)syscall(SYS_fsync, fd);
}
