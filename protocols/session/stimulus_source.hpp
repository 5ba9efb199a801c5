/// \file The force models of a pack, by opaque code: all that the trial path knows of stimuli.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/paper_model.hpp"

#include <map>
#include <string>
#include <vector>

namespace touchtrial {

/// Maps every field of a pack and makes its force model once. Thread-safe once made.
class StimulusSource {
 public:
  /// \param rendering  of the study; gains come from the pack
  /// \throws FileError if a field is missing, truncated or no field, or the pack is empty
  StimulusSource(const Pack& pack, const RenderingOptions& rendering);

  /// \throws FileError if the pack has no such code
  [[nodiscard]] const PaperModel& model(const std::string& code) const;

  /// The part of the plane that all stimuli have: what a participant is told to explore, so that
  /// its extent tells nothing.
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  std::string folder_;
  std::vector<MappedField> fields_;
  std::map<std::string, PaperModel, std::less<>> models_;
  PlaneGeometry plane_;
};

}  // namespace touchtrial
