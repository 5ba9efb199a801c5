// Attacks on what a session would present, before the first one: no database knows the pack yet.
#include "attacks/forger.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/session/key_check.hpp"
#include "study/laboratory.hpp"
#include "study/signed_pack.hpp"
#include "support/catch.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

/// A study that is prepared for people, and its station's file, which are held against each other
/// as `run` does.
struct PreparedForPeople : Laboratory {
  PreparedForPeople() { static_cast<void>(prepare()); }

  [[nodiscard]] Outcome outcome(const study::StationKey& own) const {
    try {
      study::require_complete_pack(engine::Pack(pack()), own);
    } catch (const Error&) {
      return Outcome::refused;
    }
    return Outcome::possible;
  }
  [[nodiscard]] Outcome outcome() const { return outcome(station); }

  [[nodiscard]] fs::path field(std::size_t i) const {
    return pack() / (station.stimuli[i].code + ".field");
  }
  [[nodiscard]] engine::PackManifest list() const { return engine::Pack(pack()).manifest(); }
  void write(const engine::PackManifest& manifest) const {
    engine::write_manifest(pack(), manifest);
  }

  /// Flips a bit of every byte of a file in turn, and back again.
  void flip_each(const std::string& what, const fs::path& file) const {
    RandomStream random = places_of(what);
    int possible = 0;
    const std::uintmax_t size = fs::file_size(file);
    for (std::uintmax_t at = 0; at < size; ++at) {
      const auto bit = static_cast<unsigned>(random.below(8));
      flip(file, at, bit);
      if (outcome() == Outcome::possible) {
        ++possible;
        UNSCOPED_INFO(file.string() << ", byte " << at << ", bit " << bit);
      }
      flip(file, at, bit);
    }
    CHECK(possible == 0);
    note("a flipped bit in " + what + ", before the first session", Outcome::refused,
         static_cast<int>(size));
  }

  study::StationKey station = study::station_key(key(), study::kOnlyStation);
};

void exchange(const fs::path& one, const fs::path& other) {
  const Bytes bytes = read_file(one);
  replace_file(one, read_file(other));
  replace_file(other, bytes);
}

void multiply_gains(engine::PackManifest& list, double factor) {
  for (engine::PackEntry& entry : list.entries) {
    entry.gains.tangential_n *= factor;
    entry.gains.normal_n *= factor;
  }
}

}  // namespace

TEST_CASE("a flipped bit in any byte of a pack or of a shown picture is refused") {
  const PreparedForPeople study;
  REQUIRE(study.outcome() == Outcome::possible);
  study.flip_each("the pack's list", study.pack() / "pack.json");
  study.flip_each("a field", study.field(0));
  study.flip_each("a picture", study.image(0));
  CHECK(study.outcome() == Outcome::possible);
}

TEST_CASE("what a session would present cannot be altered without the investigator's key") {
  using Alter = std::function<void(const PreparedForPeople&)>;
  const auto with_list = [](const std::function<void(engine::PackManifest&)>& change) -> Alter {
    return [change](const PreparedForPeople& study) {
      engine::PackManifest list = study.list();
      change(list);
      study.write(list);
    };
  };
  SeededEntropy entropy(66);
  const Signer forger(entropy.secret("forger"));
  const std::vector<std::pair<std::string, Alter>> attacks = {
      {"gains set to zero", with_list([](auto& list) { multiply_gains(list, 0.0); })},
      {"gains twenty times as high", with_list([](auto& list) { multiply_gains(list, 20.0); })},
      {"a pack signed with one's own key", with_list([&](auto& list) {
         multiply_gains(list, 20.0);
         list.signature = forger.sign(engine::digest_of(list));
       })},
      {"a field taken off the list", with_list([](auto& list) { list.entries.pop_back(); })},
      {"two fields exchanged, with their checksums",
       [](const PreparedForPeople& study) {
         engine::PackManifest list = study.list();
         std::swap(list.entries[0].checksum, list.entries[1].checksum);
         study.write(list);
         exchange(study.pack() / (list.entries[0].code + ".field"),
                  study.pack() / (list.entries[1].code + ".field"));
       }},
      {"two shown pictures exchanged",
       [](const PreparedForPeople& study) { exchange(study.image(0), study.image(1)); }},
      {"another picture shown, with its digest in the list",
       [](const PreparedForPeople& study) {
         write_noise(study.image(0), 99);
         engine::PackManifest list = study.list();
         list.pictures = study::picture_digests(study.station.study);
         study.write(list);
       }},
      {"a list of drafts in the pack's place",
       [](const PreparedForPeople& study) {
         engine::PackManifest list = study.list();
         list.seal = {};
         list.pictures.clear();
         list.signature = study.key().signer().sign(engine::digest_of(list));
         study.write(list);
       }},
  };
  for (const auto& [what, alter] : attacks) {
    INFO(what);
    const PreparedForPeople study;
    alter(study);
    CHECK(study.outcome() == Outcome::refused);
    note(what + ", before the first session", Outcome::refused);
  }
}

TEST_CASE("another investigator's halves in a station's file do not fit the pack") {
  const PreparedForPeople study;
  SeededEntropy entropy(66);
  const SecretKey own = entropy.secret("forger");
  const Signer forger(own);
  study::StationKey forged = study.station;
  forged.investigator_box = box_keys(own).public_half;
  CHECK(study.outcome(forged) == Outcome::refused);
  note("another investigator's box in a station's file", Outcome::refused);

  forged.investigator_signature = forger.public_half();
  forged.certificate = forger.sign(
      station_statement(forged.study_id, forged.station.name, forged.signer().public_half()));
  CHECK(study.outcome(forged) == Outcome::refused);
  note("another investigator in a station's file", Outcome::refused);

  engine::PackManifest list = study.list();
  list.investigator_box = forged.investigator_box;
  list.signature = forger.sign(engine::digest_of(list));
  study.write(list);
  CHECK(study.outcome(forged) == Outcome::possible);
  note("another investigator in a station's file and its pack", Outcome::possible);
  CHECK_THROWS_AS(session::require_decryptable(study.key(), forged, engine::Pack(study.pack())),
                  VerificationError);
  note("the same, at `key check`", Outcome::named);
}
