#include "core/hash.hpp"

#include "core/errors.hpp"
#include "core/sodium.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <variant>

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

/// Computes SHA-256 with Nettle, which uses the processor's SHA instructions.
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
    const auto count = static_cast<std::size_t>(file.gcount());
    hash.add({reinterpret_cast<const std::uint8_t*>(block.data()), count});
  }
  if (file.bad()) throw FileError(one_line(path.string()) + ": reading failed; check the disk");
  return hash.finish();
}

struct FieldHasher::State {
  explicit State(HashFunction function) {
    if (function == HashFunction::sha256) return;
    prepare_sodium();
    crypto_generichash_init(&hash.emplace<crypto_generichash_state>(), nullptr, 0, Digest{}.size());
  }
  void add(ByteView bytes) {
    if (auto* const sha = std::get_if<Sha256>(&hash)) return sha->add(bytes);
    auto& blake = std::get<crypto_generichash_state>(hash);
    crypto_generichash_update(&blake, bytes.data(), bytes.size());
  }
  [[nodiscard]] Digest finish() {
    if (auto* const sha = std::get_if<Sha256>(&hash)) return sha->finish();
    Digest digest{};
    crypto_generichash_final(&std::get<crypto_generichash_state>(hash), digest.data(),
                             digest.size());
    return digest;
  }

  std::variant<Sha256, crypto_generichash_state> hash;
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
  return state_->finish();
}

Digest keyed_hash(const Digest& key, ByteView bytes) {
  prepare_sodium();
  Digest digest{};
  crypto_generichash(digest.data(), digest.size(), bytes.data(), bytes.size(), key.data(),
                     key.size());
  return digest;
}

std::optional<Digest> digest_from_hex(std::string_view hex) {
  Digest digest{};
  if (hex.size() != 2 * digest.size()) return std::nullopt;
  const int status = sodium_hex2bin(digest.data(), digest.size(), hex.data(), hex.size(), nullptr,
                                    nullptr, nullptr);
  if (status != 0) return std::nullopt;
  return digest;
}

}  // namespace touchtrial
