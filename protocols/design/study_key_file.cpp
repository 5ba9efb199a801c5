/// \file The key's file. Its bytes follow entirely from its content and one checksum over it, so
/// that a change of any byte is detected.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/study_key.hpp"

#include <system_error>

#include <nlohmann/json.hpp>

namespace touchtrial::design {
namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "touchtrial-key";
constexpr int kVersion = 1;
constexpr std::uintmax_t kMaxKeyFileBytes = std::uintmax_t{64} << 20U;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": " + what));
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path) {
  refuse(path, "the key is altered or damaged since it was written; restore it from a backup");
}

std::filesystem::path whole(const std::filesystem::path& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path, error);
  const auto canonical = std::filesystem::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return whole(file).parent_path();
}

/// A path relative to the key, so that a study can be moved with its key. "" stays "".
std::string relative_to_key(const std::filesystem::path& target, const std::filesystem::path& key) {
  if (target.empty()) return "";
  const auto relative = whole(target).lexically_relative(folder_of(key));
  return relative.empty() ? whole(target).string() : relative.string();
}

std::filesystem::path found_from_key(const std::string& target, const std::filesystem::path& key) {
  return target.empty() ? std::filesystem::path() : whole(folder_of(key) / target);
}

std::string text_of_document(json document) {
  document.erase("check");
  document["check"] = to_hex(sha256(bytes_of(document.dump())));
  return document.dump(2) + "\n";
}

json stimuli_to_json(const StudyKey& key) {
  json list = json::array();
  for (const auto& [code, stimulus] : key.stimuli) {
    const StudyClass& shown = key.study.classes[static_cast<std::size_t>(stimulus.class_index)];
    list.push_back(
        {{"code", code},
         {"label", shown.label},
         {"image", shown.images[static_cast<std::size_t>(stimulus.exemplar)].string()},
         {"method", key.study.methods[static_cast<std::size_t>(stimulus.method)].label}});
  }
  return list;
}

json document_of(const StudyKey& key, const std::filesystem::path& path) {
  // An empty folder means the working directory; it is written relative to the key as well.
  const auto study_folder = key.study.folder.empty() ? "." : key.study.folder;
  return {{"format", kFormat},
          {"version", kVersion},
          {"study_id", key.study_id},
          {"master", to_hex(key.master)},
          {"nonce", to_hex(key.nonce)},
          {"simulated", key.simulated},
          {"study", key.study.text},
          {"study_folder", relative_to_key(study_folder, path)},
          {"pack_folder", relative_to_key(key.pack_folder, path)},
          {"stimuli", stimuli_to_json(key)}};
}

SecretKey secret_from(const json& value) {
  const auto secret = digest_from_hex(value.get_ref<const std::string&>());
  if (!secret) throw FileError("a secret of the key is not 64 hexadecimal digits");
  return *secret;
}

/// Supplies stored secrets, so that the same code makes and rebuilds a key.
class StoredEntropy final : public Entropy {
 public:
  StoredEntropy(const SecretKey& master, const SecretKey& nonce) : master_(master), nonce_(nonce) {}
  [[nodiscard]] SecretKey secret(std::string_view purpose) override {
    return purpose.ends_with("nonce") ? nonce_ : master_;
  }

 private:
  SecretKey master_;
  SecretKey nonce_;
};

StudyKey key_of(const json& document, const std::filesystem::path& path) {
  const auto& text = document.at("study").get_ref<const std::string&>();
  const auto folder = found_from_key(document.at("study_folder").get<std::string>(), path);
  const Study study = parse_study(text, folder, path.string() + ": study");
  StoredEntropy stored(secret_from(document.at("master")), secret_from(document.at("nonce")));
  StudyKey key = make_study_key(study, stored, document.at("simulated").get<bool>());
  key.pack_folder = found_from_key(document.at("pack_folder").get<std::string>(), path);
  const bool same = key.study_id == document.at("study_id").get<std::string>() &&
                    stimuli_to_json(key) == document.at("stimuli");
  if (!same) refuse_damaged(path);
  return key;
}

void check_format(const json& document, const std::filesystem::path& path) {
  const bool is_key = document.is_object() && document.contains("format") &&
                      document["format"] == kFormat && document.contains("version");
  if (!is_key) refuse(path, "is not a Touchtrial key; give the .key file that `prepare` wrote");
  if (document["version"] != kVersion) {
    refuse(path, "is a key of version " + document["version"].dump() + ", not " +
                     std::to_string(kVersion) + "; use the program that wrote it");
  }
}

}  // namespace

void save_study_key(const std::filesystem::path& path, const StudyKey& key) {
  std::string text;
  try {
    text = text_of_document(document_of(key, path));
  } catch (const json::exception&) {
    refuse(path, "cannot be written: a folder's name is not UTF-8; rename the folder");
  }
  replace_file(path, text, FileMode::owner_only);
}

StudyKey load_study_key(const std::filesystem::path& path) {
  const std::string text = text_of(read_file(path, kMaxKeyFileBytes));
  const json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    refuse(path, text.find(kFormat) == std::string::npos
                     ? "is not a Touchtrial key; give the .key file that `prepare` wrote"
                     : "the key is altered or damaged since it was written; restore it from a "
                       "backup");
  }
  check_format(document, path);
  if (text_of_document(document) != text) refuse_damaged(path);
  try {
    return key_of(document, path);
  } catch (const json::exception&) {
    refuse_damaged(path);
  } catch (const StudyError& error) {
    throw FileError(error.what());
  }
}

}  // namespace touchtrial::design
