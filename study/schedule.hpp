/// \file The trials of one participant and their order. app/windows (except
/// app/windows/participant/preview_screens.cpp) and protocols/session/participant.hpp must not
/// include it: what a participant sees depends only on study/ask.hpp.
#pragma once

#include "core/cipher.hpp"
#include "core/random.hpp"
#include "study/ask.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace touchtrial::study {

/// Indices into the study's classes, a class's images, and the study's methods. Practice classes
/// follow the study's classes.
struct StimulusIndex {
  int class_index = 0;
  int exemplar = 0;
  int method = 0;

  friend auto operator<=>(const StimulusIndex&, const StimulusIndex&) = default;
};

/// The purpose of a trial.
enum class Role {
  scored,
  lead_in,      ///< an unscored trial at the start of a block
  catch_trial,  ///< tests the participant's attention
  control,      ///< with the hand off: tests whether the answer can be heard
  practice,     ///< precedes the first trial; not part of a schedule
};

/// "scored", "lead-in", "catch", "control" or "practice"
[[nodiscard]] std::string_view name_of(Role role);

/// A texture mixed into another.
struct Mix {
  StimulusIndex other;
  double share = 0.0;  ///< share of the other texture, 0 .. 1

  friend bool operator==(const Mix&, const Mix&) = default;
};

/// One of the planes that a trial presents one after the other.
struct Plane {
  StimulusIndex field;
  bool blank = false;    ///< the wall of the field without its texture
  double gain_db = 0.0;  ///< re the pack's gain of the field
  double pitch = 1.0;    ///< factor by which the texture's pixel pitch is stretched, >= 1
  std::optional<Mix> mix{};

  friend bool operator==(const Plane&, const Plane&) = default;
};

/// The level of a track that an adaptive order presents. Catch trials belong to tracks too, but do
/// not influence them.
struct Level {
  int track = 0;  ///< from 1; 0: none
  int level = 0;  ///< index into the track's levels

  friend bool operator==(const Level&, const Level&) = default;
};

struct Trial {
  Place place{};
  Role role = Role::scored;
  /// The planes to present. Empty: Order::at chooses them when the trial is due.
  std::vector<Plane> planes{};
  std::optional<int> right{};  ///< index of the right choice; empty: no choice is right
  std::optional<Level> level{};
  std::optional<int> picture{};  ///< class whose picture is shown with the question

  /// The field of a trial with one plane.
  [[nodiscard]] StimulusIndex field() const {
    return planes.empty() ? StimulusIndex{} : planes.front().field;
  }

  friend bool operator==(const Trial&, const Trial&) = default;
};

struct Schedule {
  std::vector<Trial> trials;
  /// The index of the choice at each position of the answer screen.
  std::vector<int> layout;

  /// \return nothing if the answer is a rating
  /// \pre the layout has the position
  [[nodiscard]] std::optional<int> choice_of(const Answer& answer) const {
    const auto* const choice = std::get_if<ChoiceAnswer>(&answer);
    if (choice == nullptr) return std::nullopt;
    return layout.at(static_cast<std::size_t>(choice->position));
  }

  friend bool operator==(const Schedule&, const Schedule&) = default;
};

/// The random input of one participant's schedule. See draw_for in study/station.hpp.
struct ScheduleDraw {
  SecretKey secret{};    ///< unique to this participant
  int method_order = 0;  ///< row of the Williams design of methods, from 0
  /// The visit, from 1, in a study that divides its methods between visits; 0: all visits together.
  int visit = 0;
};

/// Draws a gain's random offset, uniformly in decibels.
/// \param range_db  width of the range, >= 0
/// \return from -range_db / 2 to range_db / 2
[[nodiscard]] double draw_rove_db(double range_db, RandomStream& random);

}  // namespace touchtrial::study
