// key check: checks that the investigator's key opens what stations seal.
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/key_check.hpp"
#include "study/key_protection.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct KeyCheckArguments {
  fs::path subject;  ///< study file or key
  fs::path key;
  fs::path pack;
  fs::path station_file;
  std::string station;
  bool json = false;
};

/// The beginning of a file; empty if it cannot be read.
std::string beginning_of(const fs::path& file) {
  std::array<char, 64> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(stream.gcount())};
}

/// Whether a file is a key, by its extension or its content.
bool is_key(const fs::path& file) {
  return ending_of(file) == ".key" || beginning_of(file).starts_with("touchtrial-protected") ||
         beginning_of(file).starts_with("{\n  \"check\": ");
}

/// The result for one station.
struct StationFinding {
  std::string name;
  fs::path file;
  std::string fault;  ///< empty if none
};

/// The files of a study.
struct CheckedStudy {
  study::PackPlace place;  ///< stations' files are searched beside it
  fs::path key_path;
  study::StudyKey key;
  fs::path pictures_folder;  ///< the study file's folder; empty: the one in a station's file
};

CheckedStudy load_checked_study(const KeyCheckArguments& arguments) {
  if (is_key(arguments.subject)) {
    if (!arguments.key.empty()) {
      throw UsageError("key check: two keys are given; give the study file, or omit --key");
    }
    study::StudyKey key = study::load_study_key(arguments.subject);
    const fs::path pack = arguments.pack.empty() ? key.pack_folder : arguments.pack;
    return {{pack, arguments.subject}, arguments.subject, std::move(key), {}};
  }
  const study::Study study = study::load_study(arguments.subject);
  const study::PackPlace place = pack_place_for(arguments.subject, arguments.pack);
  const fs::path key_path = arguments.key.empty() ? place.key : arguments.key;
  if (!path_exists(key_path)) {
    throw FileError(one_line(key_path.string()) +
                    ": does not exist; name the key with --key, or run `touchtrial prepare` first");
  }
  study::StudyKey key = study::load_study_key(key_path);
  if (!study::are_same(key.study, study)) {
    throw VerificationError(study::mismatch_of(study, key, key_path, "--key"));
  }
  return {place, key_path, std::move(key), study.folder};
}

/// The pack, chosen as by `run`.
/// \param pack_option  the value of --pack; may be empty
fs::path pack_of(const CheckedStudy& study, const study::StationKey& station,
                 const fs::path& pack_option) {
  return pack_option.empty() && path_exists(station.pack_folder) ? station.pack_folder
                                                                 : study.place.pack;
}

/// Refuses a protected file of another station or study before asking for its passphrase.
/// \param name  the expected station; empty: any station of the key
void refuse_foreign_station_file(const study::StudyKey& key, const std::string& name,
                                 const fs::path& file) {
  const std::optional<PublicKey> signer = study::unencrypted_signer(file);
  if (!signer) return;
  const auto station = std::ranges::find_if(key.stations, [&](const study::Station& candidate) {
    return study::station_key(key, candidate.name).signer().public_half() == *signer;
  });
  if (station == key.stations.end()) {
    throw VerificationError(
        "belongs to another study, or to a station that the key does not contain; give the station "
        "the file that was made with this key");
  }
  if (!name.empty() && station->name != name) {
    throw VerificationError("is the file of station " + station->name);
  }
}

StationFinding check_station(const CheckedStudy& study, const std::string& name,
                             const fs::path& file, const fs::path& pack) {
  StationFinding finding{name, file, ""};
  try {
    refuse_foreign_station_file(study.key, name, file);
    study::StationKey station = study::load_station_key(file);
    if (!study.pictures_folder.empty()) station.study.folder = study.pictures_folder;
    if (!name.empty() && station.station.name != name) {
      throw VerificationError("is the file of station " + station.station.name);
    }
    finding.name = station.station.name;
    session::require_decryptable(study.key, station, engine::Pack(pack_of(study, station, pack)));
  } catch (const Error& error) {
    finding.fault = error.what();
  }
  return finding;
}

std::vector<StationFinding> check_stations(const KeyCheckArguments& arguments,
                                           const CheckedStudy& study) {
  if (!arguments.station_file.empty()) {
    return {check_station(study, arguments.station, arguments.station_file, arguments.pack)};
  }
  std::vector<StationFinding> findings;
  for (const study::Station& station : study.key.stations) {
    if (!arguments.station.empty() && station.name != arguments.station) continue;
    const fs::path file = study.place.station(station.name);
    if (path_exists(file) || !arguments.station.empty()) {
      findings.push_back(check_station(study, station.name, file, arguments.pack));
    }
  }
  if (findings.empty()) {
    throw UsageError(
        one_line(study.place.station(arguments.station).string()) +
        ": no station file of this study exists here; give the study file, and the key with "
        "--key, or name a file with --station-file");
  }
  return findings;
}

/// Whether `run` would find the key.
bool is_beside_study(const CheckedStudy& study) {
  const fs::path key_beside_pack = study::pack_place_at(study.place.pack).key;
  std::error_code error;
  return fs::equivalent(key_beside_pack, study.key_path, error);
}

int check_key(const KeyCheckArguments& arguments) {
  const CheckedStudy study = load_checked_study(arguments);
  const std::vector<StationFinding> findings = check_stations(arguments, study);
  const bool is_beside = is_beside_study(study);
  const bool is_protected = study::is_protected(study.key_path);
  if (arguments.json) {
    nlohmann::ordered_json stations = nlohmann::ordered_json::array();
    for (const StationFinding& finding : findings) {
      stations.push_back({{"station", finding.name},
                          {"file", finding.file.string()},
                          {"opens", finding.fault.empty()},
                          {"fault", finding.fault}});
    }
    print(json_text(nlohmann::ordered_json{{"study", study.key.study.name},
                                           {"key", study.key_path.string()},
                                           {"protected", is_protected},
                                           {"beside_study", is_beside},
                                           {"stations", stations}}));
  } else {
    std::string text = fmt::format("key {} ({}protected by a passphrase)\n",
                                   study.key_path.string(), is_protected ? "" : "not ");
    for (const StationFinding& finding : findings) {
      text += fmt::format("station {}: {}: {}\n", finding.name, finding.file.string(),
                          finding.fault.empty() ? "a test record opens with the key"
                                                : "FAILED: " + one_line(finding.fault));
    }
    print(text);
  }
  if (is_beside) {
    spdlog::warn(
        "{}: the investigator's key is beside the study, which each session with a person records "
        "as a deviation; move the key to another medium before the first participant",
        study.key_path.string());
  }
  return std::ranges::all_of(findings, &std::string::empty, &StationFinding::fault) ? 0
                                                                                    : kNotVerified;
}

}  // namespace

void add_key_check_command(CLI::App& keys, Action& action) {
  const auto [command, arguments] = add_command(
      keys, action, "check",
      "Check, before the first participant, that the key opens data sealed by stations", check_key);
  command.add_option("STUDY", arguments.subject, "Study file, or its key")->required();
  auto* station = command.add_option("--station", arguments.station,
                                     "One station (default: all whose files are here)");
  command
      .add_option("--station-file", arguments.station_file,
                  "A station's file (default: <study>.station beside the pack)")
      ->excludes(station);
  add_pack_option(command, arguments.pack);
  add_key_option(command, arguments.key, "Key of the study (default: beside the pack)");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
