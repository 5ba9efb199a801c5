#include "engine/pack/field_file.hpp"

#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace touchtrial {
namespace {

static_assert(std::endian::native == std::endian::little,
              "fields are written and mapped as they lie in memory");
static_assert(sizeof(FieldSample) == 3 * sizeof(float) && alignof(FieldSample) == alignof(float) &&
                  std::is_trivially_copyable_v<FieldSample>,
              "FieldSample is the file's sample layout");

constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kSurfaceAndForce = 1;

struct Header {
  std::array<char, 8> magic = {'T', 'T', 'F', 'I', 'E', 'L', 'D', '1'};
  std::uint32_t version = kVersion;
  std::uint32_t sample_layout = kSurfaceAndForce;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  double pitch_mm = 0.0;
  std::array<std::uint8_t, 32> reserved{};
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
  if (header.version != kVersion) {
    refuse(path, "has field version " + std::to_string(header.version) + ", not " +
                     std::to_string(kVersion));
  }
  if (header.sample_layout != kSurfaceAndForce) {
    refuse(path, "has the unknown sample layout " + std::to_string(header.sample_layout));
  }
  if (!is_pitch(header.pitch_mm)) refuse(path, "has no pitch that is a finite number > 0");
  if (header.reserved != Header{}.reserved) refuse(path, "has reserved bytes that are not zero");
  return header;
}

}  // namespace

Bytes encode_field(FieldView field) {
  const PlaneGeometry& geometry = field.geometry;
  if (geometry.height_px < 1 || geometry.width_px < 1 || !is_pitch(geometry.pitch_mm)) {
    throw std::invalid_argument("encode_field: the field has no size or no pitch");
  }
  const std::int64_t pixels = std::int64_t{geometry.height_px} * geometry.width_px;
  if (pixels > kMaxImagePixels || field.samples.size() != static_cast<std::size_t>(pixels)) {
    throw std::invalid_argument("encode_field: the samples do not fill the geometry");
  }
  Header header;
  header.height_px = static_cast<std::uint32_t>(geometry.height_px);
  header.width_px = static_cast<std::uint32_t>(geometry.width_px);
  header.pitch_mm = geometry.pitch_mm;
  Bytes file(sizeof header + field.samples.size_bytes());
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, field.samples.data(), field.samples.size_bytes());
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
  if (file.size() - sizeof header != pixels * sizeof(FieldSample)) {
    refuse(path, "is truncated or overlong");
  }
  const auto* samples = reinterpret_cast<const FieldSample*>(file.data() + sizeof header);
  return {{header.pitch_mm, static_cast<int>(header.height_px), static_cast<int>(header.width_px)},
          {samples, static_cast<std::size_t>(pixels)}};
}

}  // namespace touchtrial
