// The lines of a text file, plain or gzip-compressed, in bounded memory.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace smlm {

/// What a NUL byte means: that this is no text, or (Zeiss writes one before its footer) the end.
enum class Nul { error, end };

class LineReader {
 public:
  /// Throws Error(io) when the file cannot be opened.
  explicit LineReader(const std::string& path, Nul nul = Nul::error);

  /// The next line without its end (LF, CRLF, or CR where a file has no LF), valid until the next call.
  /// False at the end. Throws Error(input) for a NUL byte, a line over 1 MiB or a damaged gzip stream.
  bool next(std::string_view& line);

  /// 1-based number of the line that next() gave last.
  std::uint64_t number() const { return number_; }

 private:
  bool refill();
  std::string_view take(std::size_t length, std::size_t end_length);

  struct Close {
    void operator()(gzFile_s* file) const { gzclose(file); }
  };
  std::string path_;
  Nul nul_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // the unread part of the buffer
  std::uint64_t number_ = 0;
  char line_end_ = 0;  // decided on the first buffer
  bool exhausted_ = false;
};

}  // namespace smlm
