#include "core/hash.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <fstream>

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

}  // namespace

Digest sha256(ByteView bytes) {
  Digest digest{};
  crypto_hash_sha256(digest.data(), bytes.data(), bytes.size());
  return digest;
}

Digest blake2b(ByteView bytes) {
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
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  std::vector<char> block(std::size_t{1} << 16);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<std::size_t>(file.gcount());
    crypto_hash_sha256_update(&state, reinterpret_cast<const std::uint8_t*>(block.data()), got);
  }
  if (file.bad()) throw FileError(one_line(path.string()) + ": reading failed; check the disk");
  Digest digest{};
  crypto_hash_sha256_final(&state, digest.data());
  return digest;
}

struct FieldHasher::State {
  explicit State(HashFunction chosen) : function(chosen) {
    crypto_hash_sha256_init(&sha);
    crypto_generichash_init(&blake, nullptr, 0, Digest{}.size());
  }
  void add(ByteView bytes) {
    if (function == HashFunction::sha256) {
      crypto_hash_sha256_update(&sha, bytes.data(), bytes.size());
    } else {
      crypto_generichash_update(&blake, bytes.data(), bytes.size());
    }
  }

  HashFunction function;
  crypto_hash_sha256_state sha;
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
  Digest digest{};
  if (state_->function == HashFunction::sha256) {
    crypto_hash_sha256_final(&state_->sha, digest.data());
  } else {
    crypto_generichash_final(&state_->blake, digest.data(), digest.size());
  }
  return digest;
}

Digest keyed_hash(const Digest& key, ByteView bytes) {
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
