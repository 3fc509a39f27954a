// Values as bytes and back: numbers, texts, vectors, Eigen matrices, and every struct that has a function
// `fields(archive, value)`. Bytes that do not fit are an smlm::Error (input).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "smlm/error.hpp"

namespace polar::states {

class Writer {
 public:
  std::string bytes;

  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }

 private:
  template <class T>
  void put(T& value) {
    if constexpr (std::is_arithmetic_v<T>)
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    else
      fields(*this, value);
  }
  void put_size(std::size_t size) {
    auto fixed = static_cast<std::uint64_t>(size);
    put(fixed);
  }
  void put(std::string& text) { put_size(text.size()), bytes += text; }
  template <class T>
  void put(std::vector<T>& values) {
    put_size(values.size());
    for (T& value : values) put(value);
  }
  template <class T, int Rows, int Columns>
  void put(Eigen::Matrix<T, Rows, Columns>& m) {
    put_size(static_cast<std::size_t>(m.rows())), put_size(static_cast<std::size_t>(m.cols()));
    bytes.append(reinterpret_cast<const char*>(m.data()), sizeof(T) * static_cast<std::size_t>(m.size()));
  }
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  void require_end() const {
    if (at_ != bytes_.size()) fail();
  }

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  [[noreturn]] static void fail() {
    throw smlm::Error(smlm::Fault::input, "checkpoint", "holds a state that this program cannot read",
                      "give --overwrite to compute again");
  }
  // The next `count` values of `size` bytes.
  const char* next(std::uint64_t count, std::size_t size) {
    if (count > (bytes_.size() - at_) / size) fail();
    const char* here = bytes_.data() + at_;
    at_ += static_cast<std::size_t>(count) * size;
    return here;
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>)
      value = *next(1, 1) != 0;
    else if constexpr (std::is_arithmetic_v<T>)
      std::memcpy(&value, next(1, sizeof value), sizeof value);
    else
      fields(*this, value);
  }
  std::uint64_t get_size() {
    std::uint64_t size = 0;
    get(size);
    return size;
  }
  void get(std::string& text) {
    const std::uint64_t size = get_size();
    text.assign(next(size, 1), size);
  }
  template <class T>
  void get(std::vector<T>& values) {
    const std::uint64_t size = get_size();
    if (size > bytes_.size() - at_) fail();  // every value takes a byte at least
    values.resize(size);
    for (T& value : values) get(value);
  }
  template <class T, int Rows, int Columns>
  void get(Eigen::Matrix<T, Rows, Columns>& m) {
    const std::uint64_t rows = get_size(), columns = get_size();
    if (rows > bytes_.size() || columns > bytes_.size()) fail();
    const char* values = next(rows * columns, sizeof(T));
    const auto r = static_cast<Eigen::Index>(rows), c = static_cast<Eigen::Index>(columns);
    if ((Rows != Eigen::Dynamic && r != Rows) || (Columns != Eigen::Dynamic && c != Columns)) fail();
    m.resize(r, c);
    if (m.size() > 0) std::memcpy(m.data(), values, sizeof(T) * static_cast<std::size_t>(m.size()));
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace polar::states
