/// \file Reads and writes key and station files. Content and checksum determine every byte, so that
/// any change is detected.
#include "core/errors.hpp"
#include "study/key_protection.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"

#include <algorithm>
#include <system_error>

#include <nlohmann/json.hpp>

namespace touchtrial::study {
namespace {

using nlohmann::json;

/// Supplies a stored secret, from which make_study_key rebuilds the key.
class StoredEntropy final : public Entropy {
 public:
  explicit StoredEntropy(const SecretKey& master) : master_(master) {}
  [[nodiscard]] SecretKey secret(std::string_view) override { return master_; }

 private:
  SecretKey master_;
};

/// A file format, and the parts of its error messages.
struct FileFormat {
  std::string_view name;
  int version;
  std::string_view title;
  std::string_view remedy;          ///< if the file is of another kind
  std::string_view version_remedy;  ///< if the file has another version
};
constexpr FileFormat kKey{"touchtrial-key", 3, "key", "give the .key file that `prepare` wrote",
                          "use the version of Touchtrial that wrote it"};
constexpr FileFormat kStation{
    "touchtrial-station", 4, "station file",
    "give the .station file that `prepare` or `plan` wrote",
    "run `touchtrial prepare` to write it again with the pack, or use the "
    "version of Touchtrial that wrote it"};

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": " + what));
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, const FileFormat& format) {
  refuse(path, "the " + std::string(format.title) +
                   " has been altered or damaged; restore it from a backup");
}

std::filesystem::path canonical_path(const std::filesystem::path& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path, error);
  const auto canonical = std::filesystem::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return canonical_path(file).parent_path();
}

/// Makes a path relative to the key, so that study and key can be moved together. An empty path
/// stays empty.
std::string relative_to_key(const std::filesystem::path& target, const std::filesystem::path& key) {
  if (target.empty()) return "";
  const auto relative = canonical_path(target).lexically_relative(folder_of(key));
  return relative.empty() ? canonical_path(target).string() : relative.string();
}

std::filesystem::path path_from_key(const std::string& target, const std::filesystem::path& key) {
  return target.empty() ? std::filesystem::path() : canonical_path(folder_of(key) / target);
}

std::string text_of_document(json document) {
  document.erase("check");
  document["check"] = to_hex(sha256(bytes_of(document.dump())));
  return document.dump(2) + "\n";
}

json stimuli_to_json(const std::vector<KeyedStimulus>& stimuli, const Study& study) {
  json list = json::array();
  for (const auto& [code, stimulus] : stimuli) {
    const StudyClass& study_class = study.class_at(stimulus.class_index);
    list.push_back(
        {{"code", code},
         {"label", study_class.label},
         {"image", study_class.images[static_cast<std::size_t>(stimulus.exemplar)].string()},
         {"method", study.methods[static_cast<std::size_t>(stimulus.method)].label}});
  }
  return list;
}

json ranges_to_json(const std::vector<EnrolmentRange>& ranges) {
  json list = json::array();
  for (const EnrolmentRange& range : ranges) list.push_back({range.first, range.last});
  return list;
}

std::vector<EnrolmentRange> ranges_from(const json& list) {
  std::vector<EnrolmentRange> ranges;
  for (const json& ends : list) {
    const EnrolmentRange range{ends.at(0).get<int>(), ends.at(1).get<int>()};
    if (range.first < 1 || range.last < range.first || range.last > kMaxEnrolments) {
      throw FileError("a station's enrolment numbers are out of range");
    }
    ranges.push_back(range);
  }
  return ranges;
}

/// The members common to both files.
json common_document(const StudyCodes& codes, const FileFormat& format,
                     const std::filesystem::path& path) {
  // An empty folder means the working directory; it is written relative to the key as well.
  const auto study_folder = codes.study.folder.empty() ? "." : codes.study.folder;
  return {{"format", format.name},
          {"version", format.version},
          {"study_id", codes.study_id},
          {"simulated", codes.simulated},
          {"study", codes.study.text},
          {"study_folder", relative_to_key(study_folder, path)},
          {"pack_folder", relative_to_key(codes.pack_folder, path)},
          {"stimuli", stimuli_to_json(codes.stimuli, codes.study)}};
}

Study study_from(const json& document, const std::filesystem::path& path) {
  const auto folder = path_from_key(document.at("study_folder").get<std::string>(), path);
  return parse_study(document.at("study").get_ref<const std::string&>(), folder,
                     path.string() + ": study");
}

Digest digest_from(const json& value) {
  const auto digest = digest_from_hex(value.get_ref<const std::string&>());
  if (!digest) throw FileError("a secret or hash is not 64 hexadecimal digits");
  return *digest;
}

json document_of(const StudyKey& key, const std::filesystem::path& path) {
  json document = common_document(key, kKey, path);
  document["master"] = to_hex(key.master);
  json stations = json::array();
  for (const Station& station : key.stations) {
    stations.push_back({{"name", station.name}, {"enrolments", ranges_to_json(station.ranges)}});
  }
  document["stations"] = std::move(stations);
  return document;
}

StudyKey key_of(const json& document, const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const json& station : document.at("stations")) {
    names.push_back(station.at("name").get<std::string>());
  }
  std::vector<Station> stations = stations_named(names);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    stations[i].ranges = ranges_from(document["stations"][i].at("enrolments"));
  }
  StoredEntropy entropy(digest_from(document.at("master")));
  StudyKey key =
      make_study_key(study_from(document, path), entropy, document.at("simulated").get<bool>());
  assign_stations(key, std::move(stations));
  key.pack_folder = path_from_key(document.at("pack_folder").get<std::string>(), path);
  const bool is_consistent = key.study_id == document.at("study_id").get<std::string>() &&
                             stimuli_to_json(key.stimuli, key.study) == document.at("stimuli");
  if (!is_consistent) refuse_damaged(path, kKey);
  return key;
}

json document_of(const StationKey& key, const std::filesystem::path& path) {
  json document = common_document(key, kStation, path);
  document["station"] = key.station.name;
  document["enrolments"] = ranges_to_json(key.station.ranges);
  document["secret"] = to_hex(key.station.secret);
  document["certificate"] = to_hex(ByteView(key.certificate));
  document["catch_code"] = key.catch_code;
  document["practice"] = stimuli_to_json(key.practice, key.study);
  document["configuration"] = key.configuration;
  document["seal"] = to_hex(key.seal);
  document["investigator_box"] = to_hex(key.investigator_box);
  document["investigator_signature"] = to_hex(key.investigator_signature);
  return document;
}

/// Reads the codes of a station file.
/// \return whether the file has exactly the study's fields
bool read_codes(const json& document, StationKey& key) {
  for (const StimulusIndex& field : presented_fields(key.study)) {
    const bool is_practice = key.study.is_practice_class(field.class_index);
    auto& list = is_practice ? key.practice : key.stimuli;
    const json& stored_stimulus = document.at(is_practice ? "practice" : "stimuli").at(list.size());
    list.push_back({stored_stimulus.at("code").get<std::string>(), field});
  }
  return stimuli_to_json(key.stimuli, key.study) == document.at("stimuli") &&
         stimuli_to_json(key.practice, key.study) == document.at("practice");
}

StationKey station_of_document(const json& document, const std::filesystem::path& path) {
  StationKey key;
  key.study = study_from(document, path);
  key.study_id = document.at("study_id").get<std::string>();
  const bool has_all_codes = read_codes(document, key);
  key.catch_code = document.at("catch_code").get<std::string>();
  key.configuration = document.at("configuration").get<std::string>();
  key.seal = digest_from(document.at("seal"));
  key.investigator_box = digest_from(document.at("investigator_box"));
  key.investigator_signature = digest_from(document.at("investigator_signature"));
  key.pack_folder = path_from_key(document.at("pack_folder").get<std::string>(), path);
  key.simulated = document.at("simulated").get<bool>();
  const std::vector<std::string> name = {document.at("station").get<std::string>()};
  key.station = stations_named(name).front();
  key.station.ranges = ranges_from(document.at("enrolments"));
  key.station.secret = digest_from(document.at("secret"));
  const auto certificate = from_hex(document.at("certificate").get_ref<const std::string&>());
  const Bytes statement =
      station_statement(key.study_id, key.station.name, key.signer().public_half());
  const bool is_certified =
      certificate && is_signed_by(key.investigator_signature, statement, *certificate);
  if (!is_certified || !has_all_codes) refuse_damaged(path, kStation);
  std::ranges::copy(*certificate, key.certificate.begin());
  return key;
}

void check_format(const json& document, const std::filesystem::path& path,
                  const FileFormat& format) {
  const bool has_format = document.is_object() && document.contains("format") &&
                          document["format"] == format.name && document.contains("version");
  if (!has_format) {
    refuse(path,
           "is not a Touchtrial " + std::string(format.title) + "; " + std::string(format.remedy));
  }
  if (document["version"] != format.version) {
    refuse(path, "is a " + std::string(format.title) + " of version " + document["version"].dump() +
                     ", not " + std::to_string(format.version) + "; " +
                     std::string(format.version_remedy));
  }
}

template <typename Key>
std::string text_of_key(const std::filesystem::path& path, const Key& key) {
  try {
    return text_of_document(document_of(key, path));
  } catch (const json::exception&) {
    refuse(path, "cannot be written: a folder's name is not UTF-8; rename the folder");
  }
}

/// Reads the document of a file's text strictly.
json read_document(const std::string& text, const std::filesystem::path& path,
                   const FileFormat& format) {
  json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    if (text.find(format.name) != std::string::npos) refuse_damaged(path, format);
    check_format(document, path, format);
  }
  check_format(document, path, format);
  if (text_of_document(document) != text) refuse_damaged(path, format);
  return document;
}

/// Parses the text of a key or station file with `make`.
template <typename Make>
auto load(const std::filesystem::path& path, const std::string& text, const FileFormat& format,
          Make make) {
  const json document = read_document(text, path, format);
  try {
    return make(document, path);
  } catch (const json::exception&) {
    refuse_damaged(path, format);
  } catch (const UsageError&) {  // from an invalid station name
    refuse_damaged(path, format);
  } catch (const StudyError& error) {
    throw FileError(error.what());
  }
}

}  // namespace

void save_study_key(const std::filesystem::path& path, const StudyKey& key) {
  save_secret_text(path, text_of_key(path, key), key.signer().public_half());
}

void save_study_key(const std::filesystem::path& path, const StudyKey& key,
                    const std::string& passphrase, const PassphraseCost& cost) {
  write_secret_text(path, text_of_key(path, key), key.signer().public_half(), passphrase, cost);
}

void save_station_key(const std::filesystem::path& path, const StationKey& key) {
  save_secret_text(path, text_of_key(path, key), key.signer().public_half());
}

StudyKey load_study_key(const std::filesystem::path& path) {
  return load(path, read_secret_text(path), kKey, key_of);
}

StationKey load_station_key(const std::filesystem::path& path) {
  return load(path, read_secret_text(path), kStation, station_of_document);
}

void protect(const std::filesystem::path& file, const std::optional<std::string>& passphrase,
             const PassphraseCost& cost) {
  const std::string text = read_secret_text(file);
  const bool is_station =
      text.find("\"format\": \"" + std::string(kStation.name) + "\"") != std::string::npos;
  const Signer signer = is_station ? load(file, text, kStation, station_of_document).signer()
                                   : load(file, text, kKey, key_of).signer();
  write_secret_text(file, text, signer.public_half(), passphrase, cost);
}

}  // namespace touchtrial::study
