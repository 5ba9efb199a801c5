#include "engine/pack/pack_files.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::engine {
namespace {

/// \param message  starts with the file's path
[[noreturn]] void refuse(const std::string& message) {
  throw FileError(message + "; copy the pack again or rebuild it with `touchtrial prepare`");
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  refuse(one_line(path.string()) + ": " + reason);
}

static_assert(std::endian::native == std::endian::little,
              "fields are written and mapped in memory layout");
constexpr std::uint32_t kFieldVersion = 3;
constexpr std::int64_t kListVersion = 5;

/// The meaning of a file's heights, by rendering model.
enum class Layout : std::uint32_t { coefficients = 2, heights = 3 };

Layout layout_of(ModelKind model) {
  return model == ModelKind::surface ? Layout::coefficients : Layout::heights;
}

struct Header {
  std::array<char, 8> magic = {'T', 'T', 'F', 'I', 'E', 'L', 'D', '1'};
  std::uint32_t version = kFieldVersion;
  Layout layout = Layout::heights;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  double pitch_mm = 0.0;
  double highest = 0.0;
  std::uint32_t neighbourhood = 0;
  std::array<std::uint8_t, 20> reserved{};
};
static_assert(sizeof(Header) == 64, "heights start on a cache line");

bool is_valid_pitch(double pitch_mm) {
  return std::isfinite(pitch_mm) && pitch_mm > 0.0;
}

Header checked_header(ByteView file, const std::filesystem::path& path) {
  Header header;
  if (file.size() < sizeof header) refuse(path, "is too short for a field file");
  std::memcpy(&header, file.data(), sizeof header);
  if (header.magic != Header{}.magic) refuse(path, "is not a field file");
  if (header.version != kFieldVersion) {
    refuse(path, "has field version " + std::to_string(header.version) + ", not " +
                     std::to_string(kFieldVersion));
  }
  if (header.layout != Layout::heights && header.layout != Layout::coefficients) {
    refuse(path, "has the unknown sample layout " +
                     std::to_string(static_cast<std::uint32_t>(header.layout)));
  }
  if (!is_valid_pitch(header.pitch_mm)) refuse(path, "has a pitch that is not a finite number > 0");
  if (!std::isfinite(header.highest))
    refuse(path, "has a highest point that is not a finite number");
  const bool is_odd = header.neighbourhood % 2 == 1;
  if (header.layout == Layout::heights &&
      (!is_odd || header.neighbourhood < 3 || header.neighbourhood > kMaxNeighbourhood)) {
    refuse(path, "has the neighbourhood " + std::to_string(header.neighbourhood) +
                     ", which is not odd and 3 to " + std::to_string(kMaxNeighbourhood));
  }
  if (header.reserved != Header{}.reserved) refuse(path, "has reserved bytes that are not zero");
  return header;
}

Header header_for(FieldView field) {
  const PlaneGeometry& geometry = field.geometry;
  if (geometry.height_px < 1 || geometry.width_px < 1 || !is_valid_pitch(geometry.pitch_mm)) {
    throw std::invalid_argument("encode_field: the field has no size or no pitch");
  }
  Header header;
  header.layout = layout_of(field.model);
  if (field.model == ModelKind::paper) {
    header.neighbourhood = static_cast<std::uint32_t>(field.neighbourhood);
  }
  const std::int64_t pixels = std::int64_t{geometry.height_px} * geometry.width_px;
  if (pixels > kMaxImagePixels || field.heights.size() != static_cast<std::size_t>(pixels)) {
    throw std::invalid_argument("encode_field: the heights do not fill the geometry");
  }
  if (!field.slope_heights.empty()) {
    throw std::invalid_argument("encode_field: a sum of fields cannot be encoded");
  }
  header.height_px = static_cast<std::uint32_t>(geometry.height_px);
  header.width_px = static_cast<std::uint32_t>(geometry.width_px);
  header.pitch_mm = geometry.pitch_mm;
  header.highest = highest_of(field);
  if (!std::isfinite(header.highest)) {
    throw std::invalid_argument("encode_field: the field has heights that are not finite");
  }
  return header;
}

}  // namespace

Bytes encode_field(FieldView field) {
  const Header header = header_for(field);
  const std::span<const std::byte> samples = std::as_bytes(field.heights);
  Bytes file(sizeof header + samples.size());
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, samples.data(), samples.size());
  return file;
}

FieldView decode_field(ByteView file, const std::filesystem::path& path) {
  const Header header = checked_header(file, path);
  // Two 32-bit sides cannot overflow a 64-bit product.
  const std::uint64_t pixels = std::uint64_t{header.height_px} * header.width_px;
  if (pixels < 1 || pixels > static_cast<std::uint64_t>(kMaxImagePixels)) {
    refuse(path, "has the impossible size " + std::to_string(header.width_px) + " x " +
                     std::to_string(header.height_px));
  }
  if (file.size() - sizeof header != pixels * sizeof(float)) {
    refuse(path, "is truncated or overlong");
  }
  FieldView view;
  view.geometry = {header.pitch_mm, static_cast<int>(header.height_px),
                   static_cast<int>(header.width_px)};
  view.highest = header.highest;
  view.model = header.layout == Layout::coefficients ? ModelKind::surface : ModelKind::paper;
  if (view.model == ModelKind::paper) view.neighbourhood = static_cast<int>(header.neighbourhood);
  view.heights = {reinterpret_cast<const float*>(file.data() + sizeof header),
                  static_cast<std::size_t>(pixels)};
  return view;
}

namespace {

constexpr std::string_view kFormat = "touchtrial-pack";

bool is_study_id(std::string_view id) {
  return !id.empty() && id.size() <= 128 && from_hex(id).has_value();
}

Gains read_gains(const JsonValue& place) {
  std::array<std::string_view, kGains.size()> names;
  std::ranges::transform(kGains, names.begin(), &NamedGain::name);
  const JsonObject object = place.object(names);
  Gains gains;
  for (const NamedGain& gain : kGains) {
    gains.*gain.value =
        object.at(gain.name).number({.low = 0.0, .high = std::numeric_limits<double>::max()});
  }
  return gains;
}

Digest read_digest(const JsonValue& place) {
  const auto digest = digest_from_hex(place.text());
  if (!digest) place.refuse("must be 64 hexadecimal digits");
  return *digest;
}

PackEntry read_entry(const JsonValue& place) {
  const JsonObject object = place.object({"checksum", "code", "gains", "input_tag"});
  PackEntry entry;
  entry.code = object.at("code").text();
  if (!is_pack_code(entry.code)) {
    object.at("code").refuse("must be 16 lower-case letters and digits");
  }
  entry.checksum = read_digest(object.at("checksum"));
  entry.input_tag = read_digest(object.at("input_tag"));
  entry.gains = read_gains(object.at("gains"));
  return entry;
}

PackManifest read_manifest_json(const JsonValue& place) {
  using Integers = std::numeric_limits<std::int64_t>;
  const JsonObject root = place.object({"fields", "format", "investigator_box", "pictures", "seal",
                                        "signature", "study_id", "version"});
  if (root.at("format").text() != kFormat) {
    root.at("format").refuse("must be \"touchtrial-pack\"");
  }
  if (root.at("version").integer(Integers::min(), Integers::max()) != kListVersion) {
    root.at("version").refuse("is not " + std::to_string(kListVersion) +
                              ", the only version that this program reads");
  }
  PackManifest manifest;
  manifest.study_id = root.at("study_id").text();
  if (!is_study_id(manifest.study_id)) root.at("study_id").refuse("must be hexadecimal");
  std::set<std::string> codes;
  for (const JsonValue& field :
       root.at("fields").items(0, std::numeric_limits<std::size_t>::max())) {
    manifest.entries.push_back(read_entry(field));
    if (!codes.insert(manifest.entries.back().code).second) {
      field.refuse_below("/code", "is in the manifest twice");
    }
  }
  manifest.seal = read_digest(root.at("seal"));
  manifest.investigator_box = read_digest(root.at("investigator_box"));
  for (const JsonValue& picture :
       root.at("pictures").items(0, std::numeric_limits<std::size_t>::max())) {
    manifest.pictures.push_back(read_digest(picture));
  }
  const auto signature = from_hex(root.at("signature").text());
  if (!signature || signature->size() != manifest.signature.size()) {
    root.at("signature").refuse("must be 128 hexadecimal digits");
  }
  std::ranges::copy(*signature, manifest.signature.begin());
  return manifest;
}

nlohmann::json json_of(const PackEntry& entry) {
  nlohmann::json gains;
  for (const NamedGain& gain : kGains) gains[std::string(gain.name)] = entry.gains.*gain.value;
  return {{"checksum", to_hex(entry.checksum)},
          {"code", entry.code},
          {"gains", std::move(gains)},
          {"input_tag", to_hex(entry.input_tag)}};
}

void check_manifest(const PackManifest& manifest) {
  if (!is_study_id(manifest.study_id)) {
    throw std::invalid_argument("write_manifest: the study id must be hexadecimal");
  }
  for (const PackEntry& entry : manifest.entries) {
    if (!is_pack_code(entry.code) || !are_valid(entry.gains)) {
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
  check_manifest(manifest);
  nlohmann::json fields = nlohmann::json::array();
  for (const PackEntry& entry : manifest.entries) fields.push_back(json_of(entry));
  nlohmann::json pictures = nlohmann::json::array();
  for (const Digest& picture : manifest.pictures) pictures.push_back(to_hex(picture));
  const nlohmann::json root = {{"fields", std::move(fields)},
                               {"format", kFormat},
                               {"investigator_box", to_hex(manifest.investigator_box)},
                               {"pictures", std::move(pictures)},
                               {"seal", to_hex(manifest.seal)},
                               {"signature", to_hex(ByteView(manifest.signature))},
                               {"study_id", manifest.study_id},
                               {"version", kListVersion}};
  return root.dump(2) + "\n";
}

PackManifest manifest_from_json(std::string_view text, const std::filesystem::path& path) {
  try {
    PackManifest manifest = read_manifest_json(parse_strict_json(text, path.string()));
    if (manifest_to_json(manifest) != text) refuse(path, "was altered after it was written");
    return manifest;
  } catch (const StudyError& error) {
    // Omits the JSON reader's remedies, which are for hand-written files.
    const std::string message = error.what();
    refuse(message.substr(0, message.find("; ", one_line(path.string()).size())));
  }
}

}  // namespace touchtrial::engine
