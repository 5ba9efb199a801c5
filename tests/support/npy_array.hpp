/// \file Reads the program's .npy files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

struct NpyArray {
  std::string type;             ///< NumPy's descr, one of "|u1", "<f4", "<f8"
  std::vector<int> shape;       ///< outermost first
  std::vector<double> samples;  ///< row-major, converted from their type
};

/// Reads a file of version 1.0 in C order.
/// \throws std::runtime_error for any other file, or if the length of its data does not match its
///   shape
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path);

}  // namespace touchtrial
