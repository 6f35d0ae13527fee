/* The fsync of a slow disk, linked into a test, or loaded ahead of libc by LD_PRELOAD: waits for as many seconds as the
   file says that the environment variable SLOW_FSYNC names, for folders alone if it says `folders` after that. The file is
   read over and over, so that whoever waits can be released; without it nobody waits. */

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static int is_folder(int fd) {
  struct stat about;
  return fstat(fd, &about) == 0 && S_ISDIR(about.st_mode);
}

static double delay(int fd) {
  const char* path = getenv("SLOW_FSYNC");
  FILE* file = path ? fopen(path, "re") : NULL;
  double seconds = 0;
  char folders[8];
  if (!file) return 0;
  const int words = fscanf(file, "%lf %7s", &seconds, folders);
  fclose(file);
  if (words == 2 && !is_folder(fd)) return 0;
  return words < 1 ? 0 : seconds;
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int fsync(int fd) {
  const struct timespec step = {0, 5000000};
  const double begin = now();
  while (now() - begin < delay(fd)) nanosleep(&step, NULL);
  return (int)syscall(SYS_fsync, fd);
}
