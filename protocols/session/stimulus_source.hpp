/// \file The force models of a pack, by opaque code. Trials identify stimuli only by these codes.
#pragma once

#include "engine/pack/pack.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "study/schedule.hpp"
#include "study/study_key.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Maps every field of a pack into memory, and makes its force model once. The constructor reads
/// only the fields' headers; samples are read from disk on first access, or by `fetch`. Thread-safe
/// once constructed.
class StimulusSource {
 public:
  /// \param rendering  of the study; gains come from the pack
  /// \throws FileError if a field is missing, truncated, malformed or of another rendering model,
  ///   or the pack is empty
  StimulusSource(const engine::Pack& pack, const engine::RenderingOptions& rendering);
  /// Overload for sessions, whose planes may have equal heights and be mixed.
  /// \throws FileError also if the pack lacks one of the codes' fields
  StimulusSource(const engine::Pack& pack, const study::StudyCodes& codes);

  /// The model of a field.
  /// \throws FileError if the pack has no such code
  [[nodiscard]] const engine::RenderingModel& model(const std::string& code) const;

  /// The model of a field at a gain that differs from the pack's. Cheap: reads no sample.
  /// \param gain_db  re the pack's gain
  /// \throws FileError if the pack has no such code
  [[nodiscard]] engine::RenderingModel model(const std::string& code, double gain_db) const;

  /// A field with its gains. It references memory of this object.
  /// \throws FileError if the pack has no such code
  [[nodiscard]] engine::FieldWithGains field(const std::string& code) const;

  /// The model of a plane. With study::Fields::has_equal_heights, mean heights are removed, so that
  /// a texture's wall coincides with that of the blank plane. Gains then scale forces, which are
  /// linear in the gains during contact and below the limits.
  /// \throws std::logic_error if the plane is not in the task's Fields::mixtures
  /// \throws FileError if the pack has no such field
  [[nodiscard]] engine::RenderingModel plane_of(const study::Plane& plane,
                                                const study::StudyCodes& codes) const;

  /// A plane without texture, for catch trials.
  [[nodiscard]] const engine::RenderingModel& blank_plane() const noexcept { return *blank_plane_; }

  /// Reads a byte of every memory page of every field, so that the servo does not wait for the
  /// disk. It reads all fields, not only the next one, because otherwise the time to read would
  /// distinguish new stimuli from repeated ones.
  void fetch() const noexcept;

  /// The area that all stimuli have in common. Participants explore this area, so that its extent
  /// reveals nothing.
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  std::string folder_;
  std::vector<engine::MappedField> fields_;
  struct Stimulus {
    engine::FieldView field;
    engine::Gains gains;
    engine::RenderingModel model;
  };
  [[nodiscard]] const Stimulus& stimulus(const std::string& code) const;

  /// Two stimuli and the share of the second; both are equal if there is no mix.
  struct Mix {
    study::StimulusIndex first;
    study::StimulusIndex second;
    double share = 0.0;
    friend auto operator<=>(const Mix&, const Mix&) = default;
  };
  /// A field with its gains applied, and a factor that equalises its strength.
  struct AppliedField {
    engine::TextureField field;
    double factor = 1.0;
  };
  [[nodiscard]] static Mix mix_of(const study::Plane& plane) noexcept;
  [[nodiscard]] engine::RenderingModel equal_height_model(const study::Plane& plane) const;
  [[nodiscard]] AppliedField apply_gains(const Mix& mix, const study::StudyCodes& codes) const;

  std::map<std::string, Stimulus, std::less<>> stimuli_;
  std::optional<engine::RenderingModel> blank_plane_;
  PlaneGeometry plane_;
  engine::RenderingOptions rendering_;
  std::map<Mix, AppliedField> mixes_;  ///< only if the fields have equal heights
};

}  // namespace touchtrial::session
