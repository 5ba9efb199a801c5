#include "engine/pack/manifest_json.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace touchtrial::engine {
namespace {

using Json = nlohmann::json;
using Pointer = Json::json_pointer;

constexpr std::string_view kFormat = "touchtrial-pack";
constexpr int kManifestVersion = 2;
constexpr int kDeepest = 4;  // of nesting in a manifest; more is refused while reading

bool is_study_id(std::string_view id) {
  return !id.empty() && id.size() <= 128 && from_hex(id).has_value();
}

bool is_gain(double gain) {
  return std::isfinite(gain) && gain >= 0.0;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& where,
                         const std::string& reason) {
  throw FileError(one_line(path.string() + ": " + where + (where.empty() ? "" : ": ") + reason) +
                  "; copy the pack again or rebuild it with `touchtrial prepare`");
}

/// Refuses what the parser would let pass: repeated keys, of which it keeps the last, and nesting.
class StrictParse {
 public:
  explicit StrictParse(const std::filesystem::path& path) : path_(path) {}

  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kDeepest) refuse(path_, "", "is nested too deeply for a manifest");
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event == Json::parse_event_t::key &&
        !open_.back().insert(parsed.get<std::string>()).second) {
      refuse(path_, "", "has the key " + parsed.dump() + " twice in one object");
    }
    return true;
  }

 private:
  const std::filesystem::path& path_;
  std::vector<std::set<std::string>> open_;
};

/// A value in the manifest, with where it stands for the message.
class Node {
 public:
  Node(const Json& value, Pointer where, const std::filesystem::path& path)
      : value_(value), where_(std::move(where)), path_(path) {}

  [[noreturn]] void refuse(const std::string& reason) const {
    engine::refuse(path_, where_.to_string(), reason);
  }

  /// Checks that this is an object with these keys and no others.
  void check_keys(std::initializer_list<const char*> keys) const {
    if (!value_.is_object()) refuse("must be an object");
    for (const auto& [key, value] : value_.items()) {
      if (std::ranges::find(keys, key) == keys.end()) at(key).refuse("is not a key of a manifest");
    }
    for (const char* key : keys) {
      if (!value_.contains(key)) at(key).refuse("is missing");
    }
  }

  [[nodiscard]] Node at(const std::string& key) const {
    static const Json missing;
    const auto found = value_.find(key);
    return {found == value_.end() ? missing : *found, where_ / key, path_};
  }

  [[nodiscard]] std::vector<Node> elements() const {
    if (!value_.is_array()) refuse("must be an array");
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < value_.size(); ++i) nodes.push_back({value_[i], where_ / i, path_});
    return nodes;
  }

  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) refuse("must be a string");
    return value_.get<std::string>();
  }

  [[nodiscard]] double gain() const {
    if (!value_.is_number() || !is_gain(value_.get<double>())) refuse("must be a number >= 0");
    return value_.get<double>();
  }

  [[nodiscard]] Digest digest() const {
    const auto digest = digest_from_hex(text());
    if (!digest) refuse("must be 64 hexadecimal digits");
    return *digest;
  }

  [[nodiscard]] bool is(const Json& expected) const { return value_ == expected; }

 private:
  const Json& value_;
  Pointer where_;
  const std::filesystem::path& path_;
};

PackEntry entry_from(const Node& node) {
  node.check_keys({"checksum", "code", "gains", "input_tag"});
  PackEntry entry;
  entry.code = node.at("code").text();
  if (!is_pack_code(entry.code)) {
    node.at("code").refuse("must be 16 lower-case letters and digits");
  }
  entry.checksum = node.at("checksum").digest();
  entry.input_tag = node.at("input_tag").digest();
  const Node gains = node.at("gains");
  gains.check_keys({"height_mm", "normal_n", "tangential_n"});
  entry.gains = {gains.at("tangential_n").gain(), gains.at("normal_n").gain(),
                 gains.at("height_mm").gain()};
  return entry;
}

PackManifest manifest_from(const Node& root) {
  root.check_keys({"fields", "format", "study_id", "version"});
  if (!root.at("format").is(kFormat)) root.at("format").refuse("must be \"touchtrial-pack\"");
  if (!root.at("version").is(kManifestVersion)) {
    root.at("version").refuse("is not " + std::to_string(kManifestVersion) +
                              ", the only version that this program reads");
  }
  PackManifest manifest;
  manifest.study_id = root.at("study_id").text();
  if (!is_study_id(manifest.study_id)) root.at("study_id").refuse("must be hexadecimal");
  std::set<std::string> codes;
  for (const Node& node : root.at("fields").elements()) {
    manifest.entries.push_back(entry_from(node));
    if (!codes.insert(manifest.entries.back().code).second) {
      node.at("code").refuse("stands in the manifest twice");
    }
  }
  std::ranges::sort(manifest.entries, {}, &PackEntry::code);
  return manifest;
}

Json json_of(const PackEntry& entry) {
  return {{"checksum", to_hex(entry.checksum)},
          {"code", entry.code},
          {"gains",
           {{"height_mm", entry.gains.height_mm},
            {"normal_n", entry.gains.normal_n},
            {"tangential_n", entry.gains.tangential_n}}},
          {"input_tag", to_hex(entry.input_tag)}};
}

void check(const PackManifest& manifest) {
  if (!is_study_id(manifest.study_id)) {
    throw std::invalid_argument("write_manifest: the study's identity must be hexadecimal");
  }
  for (const PackEntry& entry : manifest.entries) {
    if (!is_pack_code(entry.code) || !is_gain(entry.gains.tangential_n) ||
        !is_gain(entry.gains.normal_n) || !is_gain(entry.gains.height_mm)) {
      throw std::invalid_argument("write_manifest: an entry has no valid code or gains");
    }
  }
  if (std::ranges::adjacent_find(manifest.entries, {}, &PackEntry::code) !=
      manifest.entries.end()) {
    throw std::invalid_argument("write_manifest: a code occurs twice");
  }
}

}  // namespace

std::string manifest_to_json(PackManifest manifest) {
  std::ranges::sort(manifest.entries, {}, &PackEntry::code);
  check(manifest);
  Json fields = Json::array();
  for (const PackEntry& entry : manifest.entries) fields.push_back(json_of(entry));
  const Json root = {{"fields", std::move(fields)},
                     {"format", kFormat},
                     {"study_id", manifest.study_id},
                     {"version", kManifestVersion}};
  return root.dump(2) + "\n";
}

PackManifest manifest_from_json(std::string_view text, const std::filesystem::path& path) {
  Json root;
  try {
    root = Json::parse(text, StrictParse(path));
  } catch (const Json::exception& error) {
    refuse(path, "", std::string("is not valid JSON (") + error.what() + ")");
  }
  return manifest_from(Node(root, Pointer(), path));
}

}  // namespace touchtrial::engine
