// The result directory: usable before anything is computed, and ours alone while we write.
#pragma once

#include <string>
#include <vector>

#include "polar/pipeline/run.hpp"

namespace polar::pipeline {

class OutputDirectory {
 public:
  /// Creates and locks it. A lock dies with its process, so a crash leaves none behind. Throws smlm::Error
  /// (io) when it is a file, cannot be written, is locked, or holds something and neither flag is given.
  OutputDirectory(const std::string& path, const RunFlags& flags);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }

  /// Removes what earlier runs wrote and this one did not.
  void remove_other_results(const std::vector<std::string>& written) const;

 private:
  /// What a run left under temporary names when it was killed: nobody else writes here while we hold the
  /// lock.
  void remove_leftovers() const;

  std::string path_;
  std::string lock_path_;  // made beforehand: the end of a run for want of memory must not ask for more
  int lock_ = -1;
};

}  // namespace polar::pipeline
