/// \file The force models of a pack, by opaque code: all that the code of trials knows of stimuli.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Maps every field of a pack, and makes its force model once. The constructor reads the fields'
/// headers; pages of samples are read when a stylus first touches them, or by `fetch`. Thread-safe
/// once constructed.
class StimulusSource {
 public:
  /// \param rendering  of the study; gains come from the pack
  /// \throws FileError if a field is missing, truncated, malformed or of another rendering model,
  ///   or the pack is empty
  StimulusSource(const engine::Pack& pack, const engine::RenderingOptions& rendering);

  /// The model of a field.
  /// \throws FileError if the pack has no such code
  [[nodiscard]] const engine::RenderingModel& model(const std::string& code) const;

  /// A plane without texture, for catch trials.
  [[nodiscard]] const engine::RenderingModel& flat() const noexcept { return *flat_; }

  /// Reads a byte of every page of every field, so that the servo finds them in memory. All fields
  /// and not the next one alone: which pages had to be fetched, and how long that took, would tell
  /// a stimulus that was presented before from a new one.
  void fetch() const noexcept;

  /// The part of the plane that all stimuli have in common. Participants explore this part, so that
  /// its extent reveals nothing.
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  std::string folder_;
  std::vector<engine::MappedField> fields_;
  std::map<std::string, engine::RenderingModel, std::less<>> models_;
  std::optional<engine::RenderingModel> flat_;
  PlaneGeometry plane_;
};

}  // namespace touchtrial::session
