#include "core/npy.hpp"

#include "core/bytes.hpp"
#include "core/outputs.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace touchtrial {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are written in memory order");

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kAlignment = 64;  // bytes, prescribed by the format

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
  const std::size_t fixed_size = kMagic.size() + 4;
  const std::size_t total_size =
      (fixed_size + dictionary.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  dictionary.resize(total_size - fixed_size - 1, ' ');
  dictionary += '\n';
  Bytes header(kMagic.begin(), kMagic.end());
  header.push_back(1);
  header.push_back(0);
  header.push_back(static_cast<std::uint8_t>(dictionary.size() & 0xffU));
  header.push_back(static_cast<std::uint8_t>(dictionary.size() >> 8U));
  header.insert(header.end(), dictionary.begin(), dictionary.end());
  return header;
}

}  // namespace

template <typename Sample>
void write_npy(const std::filesystem::path& path, std::span<const Sample> samples,
               const std::vector<int>& shape) {
  Bytes content = header_of(descr<Sample>(), shape);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(samples.data());
  content.insert(content.end(), bytes, bytes + samples.size_bytes());
  write_output(path, ByteView(content));
}

template void write_npy(const std::filesystem::path&, std::span<const std::uint8_t>,
                        const std::vector<int>&);
template void write_npy(const std::filesystem::path&, std::span<const float>,
                        const std::vector<int>&);
template void write_npy(const std::filesystem::path&, std::span<const double>,
                        const std::vector<int>&);

}  // namespace touchtrial
