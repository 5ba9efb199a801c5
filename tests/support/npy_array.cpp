#include "support/npy_array.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace touchtrial {
namespace {

template <typename Sample>
std::vector<double> samples_from(const std::string& data) {
  std::vector<Sample> samples(data.size() / sizeof(Sample));
  std::memcpy(samples.data(), data.data(), samples.size() * sizeof(Sample));
  return {samples.begin(), samples.end()};
}

std::vector<double> samples_of(const std::string& type, const std::string& data) {
  if (type == "|u1") return samples_from<std::uint8_t>(data);
  return type == "<f4" ? samples_from<float>(data) : samples_from<double>(data);
}

std::vector<int> shape_from(const std::string& list) {
  std::vector<int> shape;
  std::istringstream numbers(list);
  for (std::string number; std::getline(numbers, number, ',');) shape.push_back(std::stoi(number));
  return shape;
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  static const std::regex kHeader(
      R"(\{'descr': '(\|u1|<f4|<f8)', 'fortran_order': False, 'shape': \(((?:\d+,)+)\), \} *\n)");
  const std::string begin("\x93NUMPY\x01\x00", 8);
  const auto at = [&](std::size_t place) { return static_cast<unsigned char>(bytes.at(place)); };
  if (!bytes.starts_with(begin)) throw std::runtime_error(path.string() + " is not a .npy file");
  const std::size_t header_size = at(8) + 256U * at(9);
  const std::string header = bytes.substr(10, header_size);
  std::smatch found;
  if (header.size() < header_size || !std::regex_match(header, found, kHeader)) {
    throw std::runtime_error(path.string() + " has an unknown header: " + header);
  }
  const std::string data = bytes.substr(10 + header_size);
  NpyArray array{found[1], shape_from(found[2]), samples_of(found[1], data)};
  std::size_t size = static_cast<std::size_t>(array.type[2] - '0');
  for (const int extent : array.shape) size *= static_cast<std::size_t>(extent);
  if (data.size() != size)
    throw std::runtime_error(path.string() + " has data that do not match its header");
  return array;
}

}  // namespace touchtrial
