#include "core/hash.hpp"

#include "core/errors.hpp"
#include "core/sodium.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <nettle/sha2.h>
#include <sodium.h>

namespace touchtrial {
namespace {

std::array<std::uint8_t, 8> little_endian(std::uint64_t number) {
  std::array<std::uint8_t, 8> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return bytes;
}

/// SHA-256 by Nettle, which uses the processor's instructions for it.
class Sha256 {
 public:
  Sha256() { sha256_init(&context_); }
  void add(ByteView bytes) { sha256_update(&context_, bytes.size(), bytes.data()); }
  [[nodiscard]] Digest finish() {
    Digest digest{};
    sha256_digest(&context_, digest.size(), digest.data());
    return digest;
  }

 private:
  sha256_ctx context_{};
};

}  // namespace

Digest sha256(ByteView bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.finish();
}

Digest blake2b(ByteView bytes) {
  prepare_sodium();
  Digest digest{};
  crypto_generichash(digest.data(), digest.size(), bytes.data(), bytes.size(), nullptr, 0);
  return digest;
}

Digest sha256_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw FileError(one_line(path.string()) +
                    ": cannot be read; check that it exists and its permissions");
  }
  Sha256 hash;
  std::vector<char> block(std::size_t{1} << 16);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<std::size_t>(file.gcount());
    hash.add({reinterpret_cast<const std::uint8_t*>(block.data()), got});
  }
  if (file.bad()) throw FileError(one_line(path.string()) + ": reading failed; check the disk");
  return hash.finish();
}

struct FieldHasher::State {
  explicit State(HashFunction chosen) : function(chosen) {
    prepare_sodium();
    crypto_generichash_init(&blake, nullptr, 0, Digest{}.size());
  }
  void add(ByteView bytes) {
    if (function == HashFunction::sha256) {
      sha.add(bytes);
    } else {
      crypto_generichash_update(&blake, bytes.data(), bytes.size());
    }
  }

  HashFunction function;
  Sha256 sha;
  crypto_generichash_state blake;
};

FieldHasher::FieldHasher(HashFunction function) : state_(std::make_unique<State>(function)) {}
FieldHasher::~FieldHasher() = default;
FieldHasher::FieldHasher(FieldHasher&&) noexcept = default;
FieldHasher& FieldHasher::operator=(FieldHasher&&) noexcept = default;

FieldHasher& FieldHasher::add(ByteView field) {
  state_->add(little_endian(field.size()));
  state_->add(field);
  return *this;
}

FieldHasher& FieldHasher::add(std::int64_t number) {
  state_->add(little_endian(sizeof number));
  state_->add(little_endian(static_cast<std::uint64_t>(number)));
  return *this;
}

Digest FieldHasher::finish() {
  if (state_->function == HashFunction::sha256) return state_->sha.finish();
  Digest digest{};
  crypto_generichash_final(&state_->blake, digest.data(), digest.size());
  return digest;
}

Digest keyed_hash(const Digest& key, ByteView bytes) {
  prepare_sodium();
  Digest digest{};
  crypto_generichash(digest.data(), digest.size(), bytes.data(), bytes.size(), key.data(),
                     key.size());
  return digest;
}

std::optional<Digest> digest_from_hex(std::string_view hex) {
  const std::optional<Bytes> bytes = from_hex(hex);
  Digest digest{};
  if (!bytes || bytes->size() != digest.size()) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), digest.begin());
  return digest;
}

}  // namespace touchtrial
