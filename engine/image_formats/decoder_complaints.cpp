#include "engine/image_formats/decoder_complaints.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace touchtrial::engine {
namespace {

constexpr std::array<std::string_view, 5> kSignsOfDamage = {
    "Corrupt JPEG data", "Premature end of JPEG", "Inconsistent progression sequence",
    "Invalid SOS parameters", "libpng error"};

/// Parts of libtiff that speak of entries of the directory; the others speak of samples.
constexpr std::array<std::string_view, 6> kAboutTiffEntries = {
    "TIFFReadDirectory", "TIFFFetch",    "TIFFSetField",
    "_TIFFVSetField",    "LZWPreDecode", "JPEGFixupTags"};
constexpr std::string_view kTiffPrefix = "OpenCV TIFF: ";

/// Some cameras pad their files with a few bytes before the end marker.
bool is_padding(std::string_view line) {
  constexpr std::string_view kPrefix = "Corrupt JPEG data: ";
  constexpr std::string_view kSuffix = " extraneous bytes before marker 0xd9";
  constexpr int kMostPadding = 16;
  if (!line.starts_with(kPrefix) || !line.ends_with(kSuffix)) return false;
  int count = kMostPadding + 1;
  std::from_chars(line.data() + kPrefix.size(), line.data() + line.size(), count);
  return count <= kMostPadding;
}

/// The decoder's own words: a progress bar may have been drawn on the same line before them.
std::string_view from_first_sign(std::string_view line) {
  std::size_t begin = line.find(kTiffPrefix);
  for (const std::string_view sign : kSignsOfDamage) begin = std::min(begin, line.find(sign));
  return begin == std::string_view::npos ? line : line.substr(begin);
}

bool is_damage(std::string_view line) {
  line = from_first_sign(line);
  const auto starts_line = [&](std::string_view sign) { return line.starts_with(sign); };
  if (is_padding(line)) return false;
  if (!line.starts_with(kTiffPrefix)) {
    return std::any_of(kSignsOfDamage.begin(), kSignsOfDamage.end(), starts_line);
  }
  line.remove_prefix(kTiffPrefix.size());
  return std::none_of(kAboutTiffEntries.begin(), kAboutTiffEntries.end(), starts_line);
}

}  // namespace

std::optional<std::string> damage_in(std::string_view printed) {
  while (!printed.empty()) {
    const std::string_view line = printed.substr(0, printed.find('\n'));
    if (is_damage(line)) return std::string(line);
    printed.remove_prefix(std::min(printed.size(), line.size() + 1));
  }
  return std::nullopt;
}

}  // namespace touchtrial::engine
