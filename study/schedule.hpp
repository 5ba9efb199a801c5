/// \file The trials of one participant and their order. Hidden from app/windows and
/// protocols/session/participant.hpp, but for app/windows/participant/preview_screens.cpp: what a
/// participant sees follows from study/ask.hpp alone.
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

/// What a trial is for.
enum class Role {
  scored,
  lead_in,      ///< begins a block, and is not scored
  catch_trial,  ///< shows whether the participant attends
  control,      ///< without the hand: whether the answer can be heard
  practice,     ///< before the first trial; not in a schedule
};

/// "scored", "lead-in", "catch", "control" or "practice"
[[nodiscard]] std::string_view name_of(Role role);

/// A texture that is mixed into another.
struct Mix {
  StimulusIndex other;
  double share = 0.0;  ///< of the other, 0 .. 1

  friend bool operator==(const Mix&, const Mix&) = default;
};

/// One of the planes that a trial presents one after the other.
struct Plane {
  StimulusIndex field;
  bool blank = false;    ///< the wall of the field without its texture
  double gain_db = 0.0;  ///< re the pack's gain of the field
  double pitch = 1.0;    ///< factor of the texture's millimetres a pixel, >= 1
  std::optional<Mix> mix{};

  friend bool operator==(const Plane&, const Plane&) = default;
};

/// The step of a track that an adaptive order presents. Catch trials are steps of tracks too, which
/// choose nothing.
struct Level {
  int track = 0;  ///< from 1; 0: none
  int level = 0;  ///< index into the track's levels

  friend bool operator==(const Level&, const Level&) = default;
};

struct Trial {
  Place place{};
  Role role = Role::scored;
  /// Empty: chosen when the trial's turn comes (Order::at).
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
  /// The choice at each position of the answer screen.
  std::vector<int> layout;

  /// \return nothing for an answer that is no choice
  /// \pre the layout has the position
  [[nodiscard]] std::optional<int> choice_of(const Answer& answer) const {
    const auto* const chosen = std::get_if<Chosen>(&answer);
    if (chosen == nullptr) return std::nullopt;
    return layout.at(static_cast<std::size_t>(chosen->position));
  }

  friend bool operator==(const Schedule&, const Schedule&) = default;
};

/// What one participant's schedule is drawn from. See draw_for in study/station.hpp.
struct ScheduleDraw {
  SecretKey secret{};    ///< this participant's alone
  int method_order = 0;  ///< row of the Williams design of methods, from 0
  /// Of a study that divides its methods between visits: whose methods, from 1; 0: all visits'.
  int visit = 0;
};

/// Draws how far a gain is roved, uniformly in decibels.
/// \param range_db  width of the range, >= 0
/// \return from -range_db / 2 to range_db / 2
[[nodiscard]] double drawn_rove_db(double range_db, RandomStream& random);

}  // namespace touchtrial::study
