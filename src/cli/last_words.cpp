#include "last_words.hpp"

#include <unistd.h>

#include <CLI/Error.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <new>

#include "smlm/error.hpp"

namespace polar::cli {

namespace {
constexpr int kUsage = static_cast<int>(smlm::Fault::usage);
constexpr int kResource = static_cast<int>(smlm::Fault::resource);
bool main_has_returned = false;

// stderr is not buffered, so this allocates nothing.
int report(int code, std::initializer_list<const char*> parts) {
  std::fputs("error: ", stderr);
  for (const char* part : parts)
    for (; *part != '\0'; ++part) std::fputc(*part == '\n' || *part == '\r' ? ' ' : *part, stderr);
  std::fputc('\n', stderr);
  return code;
}

[[noreturn]] void end() {
  // Whatever else runs at exit may be what threw. A temporary file stays; the next run removes it.
  ::_exit(std::current_exception() ? report_exception() : report(1, {"unexpected end: please report this"}));
}

// HDF5 1.10 calls exit(-1) where it gets no memory.
void end_of_a_library() {
  if (!main_has_returned) ::_exit(report(kResource, {"out of memory: a library ended the program"}));
}

// Before anything else is constructed.
[[gnu::constructor(101)]] void watch_for_other_ends() {
  std::set_terminate(end);
  std::atexit(end_of_a_library);
}
}  // namespace

int ended(int code) {
  main_has_returned = true;
  return code;
}

int report_exception() {
  try {
    throw;
  } catch (const CLI::Error& e) {
    return report(kUsage, {e.what(), ": see polar --help"});
  } catch (const smlm::Error& e) {
    return report(e.exit_code(), {e.what()});
  } catch (const std::bad_alloc&) {
    return report(kResource, {"out of memory: use fewer localisations, a coarser output.voxel_nm or a larger "
                              "machine"});
  } catch (const std::filesystem::filesystem_error& e) {
    return report(static_cast<int>(smlm::Fault::io), {e.what(), ": check the path"});
  } catch (const std::exception& e) {
    // Threads are made by a library that says so only in words.
    if (std::strstr(e.what(), "pthread_create") != nullptr)
      return report(kResource, {"no thread could be started: raise the limit on memory or processes, or use "
                                "fewer --threads"});
    return report(1, {"unexpected: ", e.what(), ": please report this"});
  } catch (...) {
    return report(1, {"unexpected end: please report this"});
  }
}

}  // namespace polar::cli
