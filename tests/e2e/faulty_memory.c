// LD_PRELOAD: the NTH allocation fails, and with FAULT=always every one after it.
#define _GNU_SOURCE
#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

// Not dlsym(): it allocates.
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static atomic_long count;
static long nth, last;

__attribute__((constructor(101))) static void begin(void) {
  const char* number = getenv("NTH");
  const char* fault = getenv("FAULT");
  nth = number == NULL ? 0 : atol(number);
  last = fault != NULL && strcmp(fault, "always") == 0 ? __LONG_MAX__ : nth;
}

static int fails(void) {
  if (nth == 0) return 0;
  const long now = atomic_fetch_add(&count, 1) + 1;
  if (now < nth || now > last) return 0;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void* calloc(size_t items, size_t size) { return fails() ? NULL : __libc_calloc(items, size); }
void* realloc(void* old, size_t size) { return fails() ? NULL : __libc_realloc(old, size); }
void* memalign(size_t alignment, size_t size) { return fails() ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }

int posix_memalign(void** out, size_t alignment, size_t size) {
  void* memory = memalign(alignment, size);
  if (memory == NULL) return ENOMEM;
  *out = memory;
  return 0;
}
