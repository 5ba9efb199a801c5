#include "core/random.hpp"

#include "core/hash.hpp"

#include <array>
#include <cstddef>

#include <boost/random/normal_distribution.hpp>

namespace touchtrial {
namespace {

std::mt19937_64 engine_of(const Digest& digest) {
  std::array<std::uint32_t, 8> words{};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    words[i / 4] |= std::uint32_t{digest[i]} << (8 * (i % 4));
  }
  std::seed_seq sequence(words.begin(), words.end());
  return std::mt19937_64(sequence);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t index)
    : engine_(engine_of(FieldHasher()
                            .add(static_cast<std::int64_t>(seed))
                            .add(purpose)
                            .add(static_cast<std::int64_t>(index))
                            .finish())) {}

RandomStream::RandomStream(const Digest& secret, std::string_view purpose, std::uint64_t index)
    : engine_(engine_of(keyed_hash(
          secret, FieldHasher().add(purpose).add(static_cast<std::int64_t>(index)).finish()))) {}

double RandomStream::normal() {
  boost::random::normal_distribution<double> standard;
  return standard(engine_);
}

}  // namespace touchtrial
