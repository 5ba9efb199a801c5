#include "core/npy.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

namespace touchtrial {
namespace {

static_assert(std::endian::native == std::endian::little,
              "samples are written as they lie in memory");

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kAlignment = 64;  // of the data, by the format's definition

template <typename Sample>
constexpr std::string_view descr() {
  if constexpr (std::is_same_v<Sample, std::uint8_t>) return "|u1";
  if constexpr (std::is_same_v<Sample, float>) return "<f4";
  if constexpr (std::is_same_v<Sample, double>) return "<f8";
}

std::string shape_text(const std::vector<int>& shape) {
  std::string text = "(";
  for (const int extent : shape) text += std::to_string(extent) + ",";
  return text + ")";
}

Bytes header_of(std::string_view type, const std::vector<int>& shape) {
  std::string dictionary = "{'descr': '" + std::string(type) +
                           "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
  const std::size_t fixed = kMagic.size() + 4;
  const std::size_t total =
      (fixed + dictionary.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  dictionary.resize(total - fixed - 1, ' ');
  dictionary += '\n';
  Bytes header(kMagic.begin(), kMagic.end());
  header.push_back(1);
  header.push_back(0);
  header.push_back(static_cast<std::uint8_t>(dictionary.size() & 0xffU));
  header.push_back(static_cast<std::uint8_t>(dictionary.size() >> 8U));
  header.insert(header.end(), dictionary.begin(), dictionary.end());
  return header;
}

[[noreturn]] void refuse(const std::string& name, const std::string& reason) {
  throw FileError(one_line(name) + ": " + reason +
                  "; give a .npy file of type u1, f4 or f8 in C order");
}

/// The text between `key` and the end of its value, found in NumPy's one-line dictionary.
std::optional<std::string_view> value_of(std::string_view dictionary, std::string_view key) {
  const std::size_t at = dictionary.find("'" + std::string(key) + "':");
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view rest = dictionary.substr(at + key.size() + 3);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  return rest;
}

std::optional<std::vector<int>> parse_shape(std::string_view text) {
  if (text.empty() || text.front() != '(') return std::nullopt;
  const std::size_t end = text.find(')');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view list = text.substr(1, end - 1);
  std::vector<int> shape;
  while (true) {
    list.remove_prefix(std::min(list.find_first_not_of(", "), list.size()));
    if (list.empty()) return shape;
    int extent = 0;
    const auto [stop, error] = std::from_chars(list.data(), list.data() + list.size(), extent);
    if (error != std::errc{} || extent < 0) return std::nullopt;
    shape.push_back(extent);
    list.remove_prefix(static_cast<std::size_t>(stop - list.data()));
  }
}

std::size_t sample_size(std::string_view type) {
  if (type == "|u1") return 1;
  if (type == "<f4") return 4;
  return type == "<f8" ? 8 : 0;
}

/// The number of bytes that the data must have, or nothing if the product overflows.
std::optional<std::size_t> data_size(const std::vector<int>& shape, std::size_t sample) {
  std::size_t bytes = sample;
  for (const int extent : shape) {
    const auto factor = static_cast<std::size_t>(extent);
    if (factor != 0 && bytes > std::numeric_limits<std::size_t>::max() / factor)
      return std::nullopt;
    bytes *= factor;
  }
  return bytes;
}

struct Layout {
  std::size_t dictionary_at = 0;
  std::size_t data_at = 0;
};

Layout layout_of(const std::string& name, ByteView file) {
  if (file.size() < 12 ||
      !std::equal(kMagic.begin(), kMagic.end(), file.begin(),
                  [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; })) {
    refuse(name, "is not a .npy file");
  }
  const int version = file[6];
  if (version != 1 && version != 2) refuse(name, "has .npy version " + std::to_string(version));
  const std::size_t dictionary_at = version == 1 ? 10 : 12;
  std::size_t length = static_cast<std::size_t>(file[8]) | static_cast<std::size_t>(file[9]) << 8U;
  if (version == 2) {
    length |= static_cast<std::size_t>(file[10]) << 16U | static_cast<std::size_t>(file[11]) << 24U;
  }
  if (dictionary_at + length > file.size()) refuse(name, "is truncated in its header");
  return {dictionary_at, dictionary_at + length};
}

template <typename Sample>
std::vector<double> doubles_from(const Bytes& data) {
  std::vector<double> values(data.size() / sizeof(Sample));
  for (std::size_t i = 0; i < values.size(); ++i) {
    Sample sample;
    std::memcpy(&sample, data.data() + i * sizeof(Sample), sizeof(Sample));
    values[i] = static_cast<double>(sample);
  }
  return values;
}

bool is_finite(const NpyArray& array) {
  if (array.type == "|u1") return true;
  const std::vector<double> values = array.as_doubles();
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

template <typename Sample>
void write_npy(const std::filesystem::path& path, std::span<const Sample> samples,
               const std::vector<int>& shape) {
  Bytes content = header_of(descr<Sample>(), shape);
  const auto* raw = reinterpret_cast<const std::uint8_t*>(samples.data());
  content.insert(content.end(), raw, raw + samples.size_bytes());
  replace_file(path, ByteView(content));
}

template void write_npy(const std::filesystem::path&, std::span<const std::uint8_t>,
                        const std::vector<int>&);
template void write_npy(const std::filesystem::path&, std::span<const float>,
                        const std::vector<int>&);
template void write_npy(const std::filesystem::path&, std::span<const double>,
                        const std::vector<int>&);

std::vector<double> NpyArray::as_doubles() const {
  if (type == "<f4") return doubles_from<float>(data);
  if (type == "<f8") return doubles_from<double>(data);
  return doubles_from<std::uint8_t>(data);
}

NpyArray read_npy(const std::filesystem::path& path) {
  return parse_npy(read_file(path), path.string());
}

NpyArray parse_npy(ByteView file, const std::string& name) {
  const Layout layout = layout_of(name, file);
  const std::string dictionary =
      text_of(file.subspan(layout.dictionary_at, layout.data_at - layout.dictionary_at));
  const auto type = value_of(dictionary, "descr");
  const auto order = value_of(dictionary, "fortran_order");
  const auto shape_value = value_of(dictionary, "shape");
  if (!type || !order || !shape_value) refuse(name, "has no complete header");
  if (!order->starts_with("False")) refuse(name, "is in Fortran order");
  NpyArray array;
  array.type = std::string(type->substr(0, 5));
  if (array.type.size() == 5) array.type = array.type.substr(1, 3);
  const std::size_t sample = sample_size(array.type);
  if (sample == 0) refuse(name, "has samples of type " + one_line(array.type));
  const auto shape = parse_shape(*shape_value);
  if (!shape) refuse(name, "has an unreadable shape");
  array.shape = *shape;
  const auto bytes = data_size(array.shape, sample);
  if (!bytes || *bytes != file.size() - layout.data_at) refuse(name, "is truncated or overlong");
  array.data.assign(file.begin() + static_cast<std::ptrdiff_t>(layout.data_at), file.end());
  if (!is_finite(array)) refuse(name, "has samples that are not finite");
  return array;
}

}  // namespace touchtrial
