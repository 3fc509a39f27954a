// LD_PRELOAD: the call that FAULT names (fsync, rename, write, short, interrupted) fails at its NTH time.
// Calls on standard streams go through.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int hit(const char* call) {
  static int count = 0;
  const char* fault = getenv("FAULT");
  const char* nth = getenv("NTH");
  return fault != NULL && nth != NULL && strcmp(fault, call) == 0 && ++count == atoi(nth);
}

static int failed(int error) {
  errno = error;
  return -1;
}

int fsync(int fd) {
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  return hit("fsync") ? failed(EIO) : next(fd);
}

int rename(const char* from, const char* to) {
  int (*next)(const char*, const char*) = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return hit("rename") ? failed(EIO) : next(from, to);
}

ssize_t write(int fd, const void* bytes, size_t count) {
  ssize_t (*next)(int, const void*, size_t) = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  if (fd <= STDERR_FILENO) return next(fd, bytes, count);
  if (hit("write")) return failed(ENOSPC);
  if (hit("interrupted")) return failed(EINTR);
  return next(fd, bytes, count > 1 && hit("short") ? 1 : count);
}
