// SHA-256 (FIPS 180-4) by libcrypto: names weights, and tells a whole checkpoint from a damaged one.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

struct evp_md_ctx_st;  // of libcrypto, which is used in src/core/sha256.cpp only

namespace polar {

/// Of bytes that come in parts.
class Sha256 {
 public:
  Sha256();
  void add(const void* data, std::size_t bytes);
  /// 64 lower-case hexadecimal digits of all that was added; more may be added afterwards.
  std::string digits() const;

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  using Context = std::unique_ptr<evp_md_ctx_st, Free>;
  static Context new_context();

  Context context_;
};

/// 64 lower-case hexadecimal digits.
std::string sha256(const void* data, std::size_t bytes);

}  // namespace polar
