// Work in a process of its own: what it breaks, exhausts or never ends is its own.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "polar/core/progress.hpp"

namespace polar::pipeline {

class ChildProcess {
 public:
  /// How it ended. `reported`: by itself, with `code` and `text` of its own; else a crash or a kill.
  struct End {
    bool reported = false;
    int code = 1;
    std::string text;
  };
  /// Returns the exit code. An exception of it becomes the code and text that `polar run` would end with.
  using Work = std::function<int(Progress&)>;

  /// Forks: call it while this process has no other thread. The child's notes come here; it is cancelled when
  /// its copy of `progress` is, in its own process group, so that a terminal's signals reach only this
  /// process; and dies with it.
  ChildProcess(const Progress& progress, const Work& work);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Becomes readable when there is something to receive.
  int descriptor() const { return pipe_; }
  /// Hands on what came; false when the child has ended.
  bool receive(const std::function<void(const std::string&)>& note);
  void signal(int number) const;
  /// Waits for it.
  End end();

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
  std::string buffer_;
  End end_;
};

}  // namespace polar::pipeline
