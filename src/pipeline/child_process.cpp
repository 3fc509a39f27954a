#include "child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>

#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
// A message: its kind, the size of its text in four bytes, the text. The last one ends the work: its text
// begins with the exit code.
constexpr char kNote = 'n', kEnd = 'e';
constexpr std::size_t kHead = 5;

void send(int pipe, char kind, const std::string& text) {
  std::string message(1, kind);
  const auto size = static_cast<std::uint32_t>(text.size());
  for (int byte = 0; byte < 4; ++byte) message += static_cast<char>(size >> (8 * byte) & 0xff);
  message += text;
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t written = ::write(pipe, message.data() + sent, message.size() - sent);
    if (written < 0 && errno != EINTR) return;
    sent += written < 0 ? 0 : static_cast<std::size_t>(written);
  }
}

std::size_t size_of(const std::string& head) {
  std::uint32_t size = 0;
  for (std::size_t byte = 0; byte < 4; ++byte)
    size |= static_cast<std::uint32_t>(static_cast<unsigned char>(head[1 + byte])) << (8 * byte);
  return size;
}

class Sender : public Progress {
 public:
  Sender(int pipe, const Progress& parent) : pipe_(pipe), parent_(parent) {}
  void note(const std::string& line) override { send(pipe_, kNote, line); }
  bool cancelled() const override { return parent_.cancelled(); }

 private:
  int pipe_;
  const Progress& parent_;
};

[[noreturn]] void run_child(const Progress& progress, const ChildProcess::Work& work, int pipe) {
  Sender sender(pipe, progress);
  int code = 1;
  std::string text;
  try {
    code = work(sender);
  } catch (const smlm::Error& e) {
    code = e.exit_code();
    text = e.what();
  } catch (const std::bad_alloc&) {
    code = static_cast<int>(smlm::Fault::resource);
    text = "out of memory: use fewer localisations, a coarser output.voxel_nm or fewer jobs";
  } catch (const std::exception& e) {
    text = std::string("unexpected: ") + e.what() + ": please report this";
  } catch (...) {
    text = "unexpected end: please report this";
  }
  send(pipe, kEnd, std::string(1, static_cast<char>(code)) + text);
  ::_exit(code);
}
}  // namespace

ChildProcess::ChildProcess(const Progress& progress, const Work& work) {
  std::array<int, 2> ends{};
  const bool piped = ::pipe2(ends.data(), O_CLOEXEC) == 0;
  const pid_t parent = ::getpid();
  pid_ = piped ? ::fork() : -1;
  if (pid_ < 0)
    throw smlm::Error(smlm::Fault::resource, "",
                      std::string("no process could be made: ") + std::strerror(errno), "use fewer --jobs");
  if (pid_ == 0) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    ::close(ends[0]);
    run_child(progress, work, ends[1]);
  }
  ::close(ends[1]);
  pipe_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  signal(SIGKILL);
  end();
}

bool ChildProcess::receive(const std::function<void(const std::string&)>& note) {
  std::array<char, 4096> block{};
  const ssize_t n = ::read(pipe_, block.data(), block.size());
  if (n < 0) return errno == EINTR;
  buffer_.append(block.data(), static_cast<std::size_t>(n));
  while (buffer_.size() >= kHead && buffer_.size() >= kHead + size_of(buffer_)) {
    const std::string text = buffer_.substr(kHead, size_of(buffer_));
    if (buffer_.front() == kNote) note(text);
    if (buffer_.front() == kEnd)
      end_ = {true, static_cast<int>(static_cast<unsigned char>(text.front())), text.substr(1)};
    buffer_.erase(0, kHead + size_of(buffer_));
  }
  return n > 0;
}

void ChildProcess::signal(int number) const { ::kill(pid_, number); }

ChildProcess::End ChildProcess::end() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  ::close(pipe_);
  if (end_.reported) return end_;
  if (WIFSIGNALED(status)) {
    end_.code = 128 + WTERMSIG(status);
    end_.text = WTERMSIG(status) == SIGKILL
                    ? "it was killed (out of memory?)"
                    : std::string("it crashed: ") + ::strsignal(WTERMSIG(status)) + ": please report this";
  } else {
    end_.code = WEXITSTATUS(status);
    end_.text = "it ended without a word: please report this";
  }
  return end_;
}

}  // namespace polar::pipeline
