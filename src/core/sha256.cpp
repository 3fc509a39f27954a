#include "polar/core/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <new>

#include "smlm/error.hpp"

namespace polar {

namespace {
// SHA-256 itself cannot fail; what can is a library that is set up without it.
void require(int succeeded) {
  if (succeeded != 1)
    throw smlm::Error(smlm::Fault::resource, "libcrypto", "gives no SHA-256",
                      "look at the machine's configuration of OpenSSL");
}
}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Context Sha256::new_context() {
  Context context(EVP_MD_CTX_new());
  if (!context) throw std::bad_alloc();
  return context;
}

Sha256::Sha256() : context_(new_context()) {
  require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void Sha256::add(const void* data, std::size_t bytes) {
  require(EVP_DigestUpdate(context_.get(), data, bytes));
}

std::string Sha256::digits() const {
  const Context ended = new_context();  // a copy, so that the stream goes on
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int bytes = 0;
  require(EVP_MD_CTX_copy_ex(ended.get(), context_.get()));
  require(EVP_DigestFinal_ex(ended.get(), digest.data(), &bytes));
  std::string text;
  for (unsigned int i = 0; i < bytes; ++i)
    for (const int shift : {4, 0}) text += "0123456789abcdef"[(digest[i] >> shift) & 15];
  return text;
}

std::string sha256(const void* data, std::size_t bytes) {
  Sha256 hash;
  hash.add(data, bytes);
  return hash.digits();
}

}  // namespace polar
