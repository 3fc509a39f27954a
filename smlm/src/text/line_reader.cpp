#include "line_reader.hpp"

#include <cerrno>
#include <cstring>

#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr std::size_t first_buffer_bytes = std::size_t{1} << 16;
constexpr std::size_t longest_line_bytes = std::size_t{1} << 20;

}  // namespace

LineReader::LineReader(const std::string& path, Nul nul)
    : path_(path), nul_(nul), file_(gzopen(path.c_str(), "rb")), buffer_(first_buffer_bytes) {
  if (!file_) throw Error(Fault::io, path, std::strerror(errno), "check the name and the permissions");
  gzbuffer(file_.get(), first_buffer_bytes);
}

bool LineReader::refill() {
  if (exhausted_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == longest_line_bytes) {
    throw Error(Fault::input, path_ + ":" + std::to_string(number_ + 1), "the line is longer than 1 MiB",
                "is this a table of text?");
  }
  if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const int read = gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(buffer_.size() - end_));
  int status = Z_OK;
  const char* reason = gzerror(file_.get(), &status);
  if (read < 0 && status == Z_ERRNO) throw Error(Fault::io, path_, std::strerror(errno), "check the file");
  if (read < 0 || status == Z_BUF_ERROR) {
    throw Error(Fault::input, path_, std::string("the gzip stream is truncated or damaged (") + reason + ")",
                "copy the file again");
  }
  exhausted_ = read == 0;
  const char* fresh = buffer_.data() + end_;
  auto kept = static_cast<std::size_t>(read);
  if (const void* found = std::memchr(fresh, '\0', kept); found != nullptr) {
    if (nul_ == Nul::error) {
      throw Error(Fault::input, path_, "holds NUL bytes, so it is not a table of text", "check its format");
    }
    kept = static_cast<std::size_t>(static_cast<const char*>(found) - fresh);
    exhausted_ = true;
  }
  end_ += kept;
  if (line_end_ == 0 && kept > 0) {
    const bool has_lf = std::memchr(buffer_.data(), '\n', end_) != nullptr;
    const bool has_cr = std::memchr(buffer_.data(), '\r', end_) != nullptr;
    line_end_ = has_cr && !has_lf ? '\r' : '\n';
  }
  return kept > 0;
}

std::string_view LineReader::take(std::size_t length, std::size_t end_length) {
  std::string_view line(buffer_.data() + begin_, length);
  begin_ += length + end_length;
  ++number_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t available = end_ - begin_;
    const void* found =
        available > searched ? std::memchr(start + searched, line_end_, available - searched) : nullptr;
    if (found != nullptr) {
      line = take(static_cast<std::size_t>(static_cast<const char*>(found) - start), 1);
      return true;
    }
    searched = available;
    if (refill()) continue;
    if (begin_ == end_) return false;
    line = take(end_ - begin_, 0);
    return true;
  }
}

}  // namespace smlm
