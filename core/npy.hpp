/// \file NumPy .npy files (format version 1.0): row-major, little-endian.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchtrial {

/// Writes an array; `shape` has the product of its members equal to the number of samples.
/// Sample is std::uint8_t, float or double. \throws FileError if the file cannot be written
template <typename Sample>
void write_npy(const std::filesystem::path& path, std::span<const Sample> samples,
               const std::vector<int>& shape);

/// Writes a plane as an array of shape (height, width).
template <typename Sample>
void write_npy(const std::filesystem::path& path, const Plane<Sample>& plane) {
  write_npy<Sample>(path, plane.samples(), {plane.height(), plane.width()});
}

/// What an .npy file holds.
struct NpyArray {
  std::string type;        ///< NumPy's descr, one of "|u1", "<f4", "<f8"
  std::vector<int> shape;  ///< outermost first
  Bytes data;              ///< row-major, little-endian

  /// The samples as doubles, whatever their type.
  [[nodiscard]] std::vector<double> as_doubles() const;
};

/// Reads version 1.0 and 2.0 files of the types above, C order.
/// \throws FileError if the file is missing, truncated, of another type or order, or has samples
///   that are not finite
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path);

/// The same from a file's bytes. \param name  what errors call it, in place of the path
[[nodiscard]] NpyArray parse_npy(ByteView file, const std::string& name);

}  // namespace touchtrial
