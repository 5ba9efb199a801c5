/// \file A small study with its pack, made without images.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/gains.hpp"
#include "study/study_key.hpp"
#include "support/temp_folder.hpp"

#include <cstdint>
#include <string>

namespace touchtrial {

/// In the study file.
inline constexpr std::uint64_t kTinyStudySeed = 7;

/// Variations of the tiny study.
struct TinyStudyOptions {
  int images = 1;                ///< a class
  bool comparison = false;       ///< two methods
  bool smooth = false;           ///< gains are zero
  double first_gain = 1.0;       ///< factor on the gains of the first class
  int side_px = 120;             ///< of the pictures, of 0.2 mm
  std::uint64_t secret = 1;      ///< codes and secrets are a function of it
  std::uint64_t schedules = 0;   ///< if not 0, schedules are a function of this alone
  std::string protocol{};        ///< another one than classification and comparison
  std::string section = "{}";    ///< that protocol's own object; empty: it has none
  std::string trials = "{}";     ///< the study file's "trials"
  std::string rendering = "{}";  ///< the study file's "rendering"
  std::string visits{};          ///< the study file's "visits"; empty: one
  int practised = 0;             ///< practice classes; `trials` says how often they are presented
  bool pictures = false;         ///< the classes' pictures are there: the textures, in grey
};

/// Five square textures (waves of one length and direction each, with random phases), with their
/// key, and their pack in a temporary folder.
class TinyStudy {
 public:
  explicit TinyStudy(const TinyStudyOptions& options = {});

  [[nodiscard]] const study::StudyKey& key() const noexcept { return key_; }
  [[nodiscard]] const engine::Pack& pack() const noexcept { return pack_; }
  /// A new path for a database.
  [[nodiscard]] std::filesystem::path next_database();

 private:
  TempFolder folder_;
  study::StudyKey key_;
  engine::Pack pack_;
  int databases_ = 0;
};

/// A texture T of one class, image and method; the same for the same arguments.
[[nodiscard]] Plane<double> tiny_texture(const study::StimulusIndex& stimulus, int side_px = 120);

}  // namespace touchtrial
