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
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::engine {
namespace {

/// \param message  with the file
[[noreturn]] void refuse(const std::string& message) {
  throw FileError(message + "; copy the pack again or rebuild it with `touchtrial prepare`");
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  refuse(one_line(path.string()) + ": " + reason);
}

static_assert(std::endian::native == std::endian::little,
              "fields are written and mapped in the layout that they have in memory");
static_assert(sizeof(FieldSample) == 3 * sizeof(float) && alignof(FieldSample) == alignof(float) &&
                  std::is_trivially_copyable_v<FieldSample>,
              "FieldSample is the file's sample layout");

constexpr std::uint32_t kFieldVersion = 2;

/// The kinds of samples that a file may hold.
enum class Layout : std::uint32_t { surface_and_force = 1, coefficients = 2 };

struct Header {
  std::array<char, 8> magic = {'T', 'T', 'F', 'I', 'E', 'L', 'D', '1'};
  std::uint32_t version = kFieldVersion;
  Layout layout = Layout::surface_and_force;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  double pitch_mm = 0.0;
  double highest = 0.0;
  std::array<std::uint8_t, 24> reserved{};
};
static_assert(sizeof(Header) == 64, "samples start on a cache line");

bool is_pitch(double pitch_mm) {
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
  if (header.layout != Layout::surface_and_force && header.layout != Layout::coefficients) {
    refuse(path, "has the unknown sample layout " +
                     std::to_string(static_cast<std::uint32_t>(header.layout)));
  }
  if (!is_pitch(header.pitch_mm)) refuse(path, "has a pitch that is not a finite number > 0");
  if (!std::isfinite(header.highest))
    refuse(path, "has a highest point that is not a finite number");
  if (header.reserved != Header{}.reserved) refuse(path, "has reserved bytes that are not zero");
  return header;
}

std::size_t sample_size(Layout layout) {
  return layout == Layout::coefficients ? sizeof(float) : sizeof(FieldSample);
}

Layout layout_of(FieldView field) {
  return field.coefficients.empty() ? Layout::surface_and_force : Layout::coefficients;
}

/// The bytes of a view's samples or coefficients.
std::span<const std::byte> samples_of(FieldView field) {
  return layout_of(field) == Layout::coefficients ? std::as_bytes(field.coefficients)
                                                  : std::as_bytes(field.samples);
}

Header header_for(FieldView field) {
  const PlaneGeometry& geometry = field.geometry;
  if (geometry.height_px < 1 || geometry.width_px < 1 || !is_pitch(geometry.pitch_mm)) {
    throw std::invalid_argument("encode_field: the field has no size or no pitch");
  }
  Header header;
  header.layout = layout_of(field);
  const std::int64_t pixels = std::int64_t{geometry.height_px} * geometry.width_px;
  if (pixels > kMaxImagePixels ||
      samples_of(field).size() != static_cast<std::size_t>(pixels) * sample_size(header.layout)) {
    throw std::invalid_argument("encode_field: the samples do not fill the geometry");
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
  const std::span<const std::byte> samples = samples_of(field);
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
  if (file.size() - sizeof header != pixels * sample_size(header.layout)) {
    refuse(path, "is truncated or overlong");
  }
  FieldView view;
  view.geometry = {header.pitch_mm, static_cast<int>(header.height_px),
                   static_cast<int>(header.width_px)};
  view.highest = header.highest;
  const std::uint8_t* first = file.data() + sizeof header;
  const auto count = static_cast<std::size_t>(pixels);
  if (header.layout == Layout::coefficients) {
    view.coefficients = {reinterpret_cast<const float*>(first), count};
  } else {
    view.samples = {reinterpret_cast<const FieldSample*>(first), count};
  }
  return view;
}

namespace {

constexpr std::string_view kFormat = "touchtrial-pack";
constexpr int kManifestVersion = 2;

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
  const JsonObject root = place.object({"fields", "format", "study_id", "version"});
  if (root.at("format").text() != kFormat) {
    root.at("format").refuse("must be \"touchtrial-pack\"");
  }
  if (root.at("version").integer(Integers::min(), Integers::max()) != kManifestVersion) {
    root.at("version").refuse("is not " + std::to_string(kManifestVersion) +
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
  std::ranges::sort(manifest.entries, {}, &PackEntry::code);
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
  const nlohmann::json root = {{"fields", std::move(fields)},
                               {"format", kFormat},
                               {"study_id", manifest.study_id},
                               {"version", kManifestVersion}};
  return root.dump(2) + "\n";
}

PackManifest manifest_from_json(std::string_view text, const std::filesystem::path& path) {
  try {
    return read_manifest_json(parse_strict_json(text, path.string()));
  } catch (const StudyError& error) {
    // The reader's own remedies are for files that people write; nobody writes this one.
    const std::string message = error.what();
    refuse(message.substr(0, message.find("; ", one_line(path.string()).size())));
  }
}

}  // namespace touchtrial::engine
