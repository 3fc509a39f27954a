#include "smlm/isolation.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr int out_of_memory = 3;  // exit status of the child

// A line of /proc/self/status such as "VmPeak:    1234 kB", in bytes; 0 where there is none.
std::uint64_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.compare(0, key.size(), key) == 0)
      return std::strtoull(line.c_str() + key.size(), nullptr, 10) * 1024;
  }
  return 0;
}

// Returns the limit on the address space that was set, 0 if none could be.
std::uint64_t limit_memory(std::uint64_t bytes) {
  const std::uint64_t now = status_bytes("VmSize:");
  const rlimit space{now + bytes, now + bytes};
  return now > 0 && ::setrlimit(RLIMIT_AS, &space) == 0 ? now + bytes : 0;
}

// A message is the fault's number in one byte, then the text.
void send(int pipe, const Error& error) {
  std::string message(1, static_cast<char>(error.exit_code()));
  message += error.what();
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t written = ::write(pipe, message.data() + sent, message.size() - sent);
    if (written < 0 && errno != EINTR) return;
    sent += written < 0 ? 0 : static_cast<std::size_t>(written);
  }
}

std::string receive(int pipe) {
  std::string message;
  std::array<char, 4096> buffer{};
  while (true) {
    const ssize_t read = ::read(pipe, buffer.data(), buffer.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return message;
    message.append(buffer.data(), static_cast<std::size_t>(read));
  }
}

[[noreturn]] void run_child(const std::function<void()>& attempt, const ReadingLimits& limits, int pipe) {
  for (const int deadly : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM, SIGTERM, SIGINT})
    std::signal(deadly, SIG_DFL);
  const int silence = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (silence >= 0) {
    ::dup2(silence, STDOUT_FILENO);
    ::dup2(silence, STDERR_FILENO);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const std::uint64_t most = limit_memory(limits.memory_bytes);
  ::alarm(limits.seconds);
  try {
    attempt();
  } catch (const std::bad_alloc&) {
    ::_exit(out_of_memory);
  } catch (const Error& error) {
    send(pipe, error);
  } catch (...) {  // NOLINT: any other exception is a survival; the parent will meet it again
  }
  // C libraries turn a failed allocation into an error of their own, so the peak has the last word.
  constexpr std::uint64_t margin_bytes = 64 << 20;
  ::_exit(most > 0 && status_bytes("VmPeak:") + margin_bytes > most ? out_of_memory : 0);
}

}  // namespace

void require_survival(const std::string& path, const std::function<void()>& attempt,
                      const ReadingLimits& limits) {
  std::array<int, 2> ends{};
  const bool piped = ::pipe2(ends.data(), O_CLOEXEC) == 0;
  const pid_t child = piped ? ::fork() : -1;
  if (child < 0) {
    throw Error(Fault::resource, path,
                std::string("no process could be made to read it (") + std::strerror(errno) + ")");
  }
  if (child == 0) run_child(attempt, limits, ends[1]);
  ::close(ends[1]);
  const std::string message = receive(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(Fault::resource, path, "the process that reads it was lost");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    if (!message.empty()) throw Error(static_cast<Fault>(message.front()), "", message.substr(1));
    return;
  }
  const bool late = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
  const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  if (WIFEXITED(status) && WEXITSTATUS(status) == out_of_memory) {
    throw Error(Fault::resource, path, "reading it takes far more memory than a file of its size should",
                "is it damaged?");
  }
  if (killed) throw Error(Fault::resource, path, "the process that read it was killed (out of memory?)");
  throw Error(
      Fault::input, path,
      late ? "is damaged: reading it does not end" : "is damaged: it crashes the library that reads it",
      "write or copy it again");
}

ReadingLimits reading_limits(const std::string& path) {
  constexpr std::uintmax_t slowest_bytes_per_s = 2 << 20;
  constexpr std::uintmax_t least_s = 20;
  constexpr std::uintmax_t most_s = 1 << 20;
  constexpr std::uintmax_t least_bytes = std::uintmax_t{2} << 30;
  constexpr std::uintmax_t bytes_per_byte = 100;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return {least_s, least_bytes};
  return {static_cast<unsigned>(std::min(least_s + bytes / slowest_bytes_per_s, most_s)),
          least_bytes + bytes * bytes_per_byte};
}

}  // namespace smlm
