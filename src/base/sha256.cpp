// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {

std::string sha256_of_file(const std::filesystem::path& file) {
  const auto unreadable = [&] {
    return Error(ErrorCode::file_unreadable, "the file can't be read", Spot{.file = file.string()});
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!in) throw unreadable();
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> digest(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  const auto require = [](int done) {
    if (done != 1) throw Error(ErrorCode::internal, "the library that makes SHA-256 failed; please report this");
  };
  require(digest != nullptr ? EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) : 0);
  std::vector<char> block(1 << 20);
  std::size_t size = 0;
  while ((size = std::fread(block.data(), 1, block.size(), in.get())) > 0) {
    require(EVP_DigestUpdate(digest.get(), block.data(), size));
  }
  if (std::ferror(in.get()) != 0) throw unreadable();
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int count = 0;
  require(EVP_DigestFinal_ex(digest.get(), bytes.data(), &count));
  std::string text;
  for (unsigned int i = 0; i < count; ++i) {
    constexpr char digits[] = "0123456789abcdef";
    text += digits[bytes[i] >> 4];
    text += digits[bytes[i] & 15];
  }
  return text;
}

}  // namespace pcbmesh
