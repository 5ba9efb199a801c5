/// \file A study of three small images to prepare, for tests.
#pragma once

#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "study/prepare.hpp"
#include "study/study_examples.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

namespace touchtrial {

inline constexpr int kSide = 24;

inline void write_noise(const std::filesystem::path& path, std::uint64_t seed) {
  RandomStream random(seed, "test image");
  GreyImage image(kSide, kSide);
  for (auto& sample : image.samples()) sample = static_cast<std::uint8_t>(random.below(256));
  engine::write_png(path, image);
}

/// A study of three small images in a folder of its own.
struct Laboratory {
  TempFolder folder;
  nlohmann::json document = study_of(3);
  std::uint64_t key_seed = 1;
  bool simulated = false;

  Laboratory() {
    for (std::uint64_t c = 0; c < 3; ++c) write_noise(image(c), c);
  }
  [[nodiscard]] std::filesystem::path image(std::uint64_t c) const {
    return folder.path() / ("c" + std::to_string(c) + "_0.png");
  }
  [[nodiscard]] std::filesystem::path pack() const { return folder.path() / "small.pack"; }
  [[nodiscard]] study::StudyKey key() const {
    SeededEntropy entropy(key_seed);
    return study::make_study_key(parsed(document, folder.path()), entropy, simulated);
  }
  [[nodiscard]] study::PrepareReport prepare() const { return study::prepare_pack(key(), pack()); }
  [[nodiscard]] std::map<std::string, Bytes> files() const {
    std::map<std::string, Bytes> files;
    for (const auto& file : std::filesystem::directory_iterator(pack())) {
      files[file.path().filename().string()] = read_file(file.path());
    }
    return files;
  }
};

inline int reused(const study::PrepareReport& report) {
  return static_cast<int>(
      std::ranges::count(report.stimuli, true, &study::PreparedStimulus::reused));
}

inline bool warns(const study::PrepareReport& report, const std::string& places) {
  return std::ranges::any_of(report.warnings,
                             [&](const std::string& warning) { return names(warning, places); });
}

}  // namespace touchtrial
