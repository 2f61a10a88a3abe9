// LD_PRELOADed: the GLINT_FAULT_AT-th write to a file beneath GLINT_FAULT_UNDER fails with EIO, as
// on a disk that goes bad, and so does every later one.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static int Beneath(int descriptor) {
  const char* folder = getenv("GLINT_FAULT_UNDER");
  if (folder == NULL) return 0;
  char link[64], path[4096];
  snprintf(link, sizeof(link), "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof(path) - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return strncmp(path, folder, strlen(folder)) == 0;
}

static int Fails(int descriptor) {
  static atomic_int writes;
  const char* at = getenv("GLINT_FAULT_AT");
  if (at == NULL || !Beneath(descriptor)) return 0;
  if (atomic_fetch_add(&writes, 1) + 1 < atoi(at)) return 0;
  errno = EIO;
  return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int descriptor, const void* bytes, size_t count) {
  return Fails(descriptor) ? -1 : REAL(write)(descriptor, bytes, count);
}
ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  return Fails(descriptor) ? -1 : REAL(writev)(descriptor, parts, count);
}
ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  return Fails(descriptor) ? -1 : REAL(pwrite)(descriptor, bytes, count, offset);
}
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  return Fails(fileno(file)) ? 0 : REAL(fwrite)(bytes, size, count, file);
}
int fsync(int descriptor) { return Fails(descriptor) ? -1 : REAL(fsync)(descriptor); }
