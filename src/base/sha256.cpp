// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/sha256.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string_view>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {
namespace {

void require(int done) {
  if (done != 1) throw Error(ErrorCode::internal, "the library that makes SHA-256 failed; please report this");
}

class Digest {
 public:
  Digest() { require(context_ != nullptr ? EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) : 0); }
  void add(std::string_view bytes) { require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size())); }
  void add_file(const std::filesystem::path& file) {
    const auto unreadable = [&] {
      return Error(ErrorCode::file_unreadable, "the file can't be read", Spot{.file = file.string()});
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
    if (!in) throw unreadable();
    std::vector<char> block(1 << 20);
    std::size_t size = 0;
    while ((size = std::fread(block.data(), 1, block.size(), in.get())) > 0) add({block.data(), size});
    if (std::ferror(in.get()) != 0) throw unreadable();
  }
  [[nodiscard]] std::string text() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned int count = 0;
    require(EVP_DigestFinal_ex(context_.get(), bytes.data(), &count));
    std::string text;
    for (unsigned int i = 0; i < count; ++i) {
      constexpr char digits[] = "0123456789abcdef";
      text += digits[bytes[i] >> 4];
      text += digits[bytes[i] & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

}  // namespace

std::string sha256_of_file(const std::filesystem::path& file) {
  Digest digest;
  if (!std::filesystem::is_directory(file)) {
    digest.add_file(file);
    return digest.text();
  }
  std::vector<std::filesystem::path> members;
  for (const auto& entry : std::filesystem::directory_iterator(file))
    if (entry.is_regular_file()) members.push_back(entry.path());
  std::sort(members.begin(), members.end());
  for (const std::filesystem::path& member : members)
    digest.add(sha256_of_file(member) + "  " + member.filename().string() + "\n");
  return digest.text();
}

}  // namespace pcbmesh
