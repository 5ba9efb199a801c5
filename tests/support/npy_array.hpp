/// \file The program's .npy files, read back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

struct NpyArray {
  std::string type;             ///< NumPy's descr, one of "|u1", "<f4", "<f8"
  std::vector<int> shape;       ///< outermost first
  std::vector<double> samples;  ///< row-major, whatever their type
};

/// Reads a file of version 1.0 in C order.
/// \throws std::runtime_error if it is anything else, or the length of its data does not match its
///   shape
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path);

}  // namespace touchtrial
