#include "program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
// One of its streams, read here.
class Stream {
 public:
  explicit Stream(int number) : number_(number) {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw smlm::Error(smlm::Fault::resource, "", std::string("no pipe: ") + std::strerror(errno));
  }
  ~Stream() {
    close(ends_[0]);
    close(ends_[1]);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  void give_to(posix_spawn_file_actions_t& child) const {
    ::posix_spawn_file_actions_adddup2(&child, ends_[1], number_);
  }
  void was_given() { close(ends_[1]); }
  pollfd waited_for() const { return {ends_[0], POLLIN, 0}; }  // one that is closed is passed over
  bool open() const { return ends_[0] >= 0; }
  void read_some() {
    std::array<char, 4096> block{};
    const ssize_t n = ::read(ends_[0], block.data(), block.size());
    if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) close(ends_[0]);
  }

  std::string text;

 private:
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  int number_;
  std::array<int, 2> ends_{-1, -1};
};

int waited(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int kSignalled = 128;
  return WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status);
}
}  // namespace

ProgramEnd run_program(const std::vector<std::string>& words) {
  Stream output(STDOUT_FILENO), errors(STDERR_FILENO);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  output.give_to(actions);
  errors.give_to(actions);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int fault = ::posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (fault != 0)
    throw smlm::Error(smlm::Fault::resource, words.front(),
                      std::string("cannot be started: ") + std::strerror(fault));
  output.was_given();
  errors.was_given();
  while (output.open() || errors.open()) {
    std::array<pollfd, 2> both{output.waited_for(), errors.waited_for()};
    if (::poll(both.data(), both.size(), -1) < 0 && errno != EINTR) break;
    if (both[0].revents != 0) output.read_some();
    if (both[1].revents != 0) errors.read_some();
  }
  return {waited(pid), output.text, errors.text};
}

}  // namespace polar::pipeline
