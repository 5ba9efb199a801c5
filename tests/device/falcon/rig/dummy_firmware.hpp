/// \file Bytes in the place of the vendor's firmware, which is licensed and not ours to have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace touchtrial::device::falcon {

/// As long as a known image; every byte value occurs.
inline std::vector<std::uint8_t> dummy_firmware() {
  std::vector<std::uint8_t> image(8492);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  }
  return image;
}

inline std::filesystem::path write_dummy_firmware(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "falcon-firmware.bin";
  const std::vector<std::uint8_t> image = dummy_firmware();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  return file;
}

}  // namespace touchtrial::device::falcon
