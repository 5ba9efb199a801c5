// One bit flipped in a file of a study: every byte of the small files in turn, and places of the
// database that a seed decides. pack_test.cpp has the pack.
#include "attacks/forger.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/head_file.hpp"
#include "support/catch.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

/// Flips a bit of every byte in turn, and back again.
/// \param step  1: every byte
/// \param outcome  of the damaged file
template <typename OutcomeOf>
void flip_each(const std::string& what, const fs::path& file, std::uintmax_t step,
               OutcomeOf outcome) {
  RandomStream random = places_of(what);
  std::map<Outcome, int> counts;
  const std::uintmax_t size = fs::file_size(file);
  for (std::uintmax_t at = 0; at < size; at += step) {
    const auto bit = static_cast<unsigned>(random.below(8));
    INFO(file.string() << ", byte " << at << ", bit " << bit);
    flip(file, at, bit);
    ++counts[outcome()];
    flip(file, at, bit);
  }
  CHECK(counts[Outcome::possible] == 0);
  for (const auto& [found, count] : counts) note("a flipped bit in " + what, found, count);
}

template <typename Load>
Outcome refused_by(Load load) {
  try {
    static_cast<void>(load());
  } catch (const Error&) {
    return Outcome::refused;
  }
  return Outcome::possible;
}

/// What became of the study's database after a flip.
Outcome outcome_of(const AttackedStudy& study, const std::string& whole) {
  if (rows_of(study.database()) == whole) return Outcome::unchanged;
  try {
    return study.found().empty() ? Outcome::possible : Outcome::named;
  } catch (const Error&) {
    return Outcome::refused;
  }
}

}  // namespace

TEST_CASE("a flipped bit in any byte of a key or a station's file is refused") {
  AttackedStudy study(0);
  study.close();
  flip_each("the key", study.key_file(), 1,
            [&] { return refused_by([&] { return study::load_study_key(study.key_file()); }); });
  flip_each("a station's file", study.station_file(), 1, [&] {
    return refused_by([&] { return study::load_station_key(study.station_file()); });
  });
}

TEST_CASE("a flipped bit in any byte of a head file is told") {
  AttackedStudy study(0);
  study.close();
  const std::vector<PublicKey> signers = {study.station().signer().public_half()};
  const record::HeadFile head(study.head());
  // tests/record/head_file_test.cpp has every byte of another one.
  const std::uintmax_t step = places(0) > 0 ? 1 : 61;
  flip_each("a head file", study.head(), step, [&] {
    const auto reading = head.reading(signers);
    return reading && !reading->damage.empty() ? Outcome::named : Outcome::possible;
  });
}

TEST_CASE("a flipped bit anywhere in the database is named, refused, or changes no row") {
  AttackedStudy study;
  study.close();
  const std::string whole = rows_of(study.database());
  const Bytes bytes = read_file(study.database());
  RandomStream random = places_of("database");
  std::map<Outcome, int> counts;
  for (int i = 0; i < places(300); ++i) {
    const std::uintmax_t at = random.below(bytes.size());
    const auto bit = static_cast<unsigned>(random.below(8));
    INFO("byte " << at << ", bit " << bit);
    flip(study.database(), at, bit);
    const Outcome outcome = outcome_of(study, whole);
    CHECK(outcome != Outcome::possible);
    ++counts[outcome];
    flip(study.database(), at, bit);
  }
  CHECK(counts[Outcome::named] > 0);
  for (const auto& [outcome, count] : counts) {
    note("a flipped bit in the database", outcome, count);
  }
  CHECK(rows_of(study.database()) == whole);
}
