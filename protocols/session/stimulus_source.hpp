/// \file The force models of a pack, by opaque code: all that the trial path knows of stimuli.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Maps every field of a pack and makes its force model once. Of a field, this reads the header;
/// pages of samples are read when a stylus first touches them, or by `fetch`. Thread-safe once
/// made.
class StimulusSource {
 public:
  /// \param rendering  of the study; gains come from the pack
  /// \throws FileError if a field is missing, truncated, no field or of another model, or the pack
  ///   is empty
  StimulusSource(const engine::Pack& pack, const engine::RenderingOptions& rendering);

  /// \throws FileError if the pack has no such code
  [[nodiscard]] const engine::RenderingModel& model(const std::string& code) const;

  /// A plane without texture, for catch trials.
  [[nodiscard]] const engine::RenderingModel& flat() const noexcept { return *flat_; }

  /// Reads a byte of every page of every field, so that the servo finds them in memory. Of all and
  /// not of the one that comes next: which pages had to be fetched, and how long that took, would
  /// tell a stimulus that was there before from a new one.
  void fetch() const noexcept;

  /// The part of the plane that all stimuli have: what a participant is told to explore, so that
  /// its extent tells nothing.
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  std::string folder_;
  std::vector<engine::MappedField> fields_;
  std::map<std::string, engine::RenderingModel, std::less<>> models_;
  std::optional<engine::RenderingModel> flat_;
  PlaneGeometry plane_;
};

}  // namespace touchtrial::session
