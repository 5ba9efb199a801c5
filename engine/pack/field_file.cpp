#include "engine/pack/field_file.hpp"

#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace touchtrial::engine {
namespace {

static_assert(std::endian::native == std::endian::little,
              "fields are written and mapped as they lie in memory");
static_assert(sizeof(FieldSample) == 3 * sizeof(float) && alignof(FieldSample) == alignof(float) &&
                  std::is_trivially_copyable_v<FieldSample>,
              "FieldSample is the file's sample layout");

constexpr std::uint32_t kFieldVersion = 2;

/// What a file's samples are.
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

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw FileError(one_line(path.string()) + ": " + reason +
                  "; copy the pack again or rebuild it with `touchtrial prepare`");
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
  if (!is_pitch(header.pitch_mm)) refuse(path, "has no pitch that is a finite number > 0");
  if (!std::isfinite(header.highest)) refuse(path, "has no highest point that is a finite number");
  if (header.reserved != Header{}.reserved) refuse(path, "has reserved bytes that are not zero");
  return header;
}

std::size_t sample_size(Layout layout) {
  return layout == Layout::coefficients ? sizeof(float) : sizeof(FieldSample);
}

/// The bytes of a view's samples, of either kind.
std::span<const std::byte> samples_of(FieldView field) {
  return field.model() == ModelKind::surface ? std::as_bytes(field.coefficients)
                                             : std::as_bytes(field.samples);
}

Header header_for(FieldView field) {
  const PlaneGeometry& geometry = field.geometry;
  if (geometry.height_px < 1 || geometry.width_px < 1 || !is_pitch(geometry.pitch_mm)) {
    throw std::invalid_argument("encode_field: the field has no size or no pitch");
  }
  Header header;
  header.layout =
      field.model() == ModelKind::surface ? Layout::coefficients : Layout::surface_and_force;
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

}  // namespace touchtrial::engine
