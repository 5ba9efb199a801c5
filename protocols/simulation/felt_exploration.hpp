/// \file A simulated hand that explores a plane, and what it feels: no session, no trace.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/servo/servo.hpp"
#include "engine/perception/felt_features.hpp"
#include "engine/perception/texture_sense.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cstdint>

namespace touchtrial::simulation {

/// What a subject feels through a hand: the servo's forces, or how they accelerate the tip.
class HandSense final : private device::TipSense {
 public:
  explicit HandSense(const SubjectModel& subject);
  HandSense(const HandSense&) = delete;
  HandSense& operator=(const HandSense&) = delete;
  ~HandSense() override = default;

  /// Starts anew, with a hand at the beginning of its exploration; the hand must not outlive this.
  void begin(device::SimulatedHand& hand, const PlaneGeometry& plane);
  /// A sample of the servo. Cost: as TextureSense.
  void feel(const device::ServoSample& sample) noexcept;
  /// Before what a person adds: FeltDecision. After the last tick alone.
  [[nodiscard]] engine::FeltFeatures features() const noexcept { return sense_.features(); }
  /// TextureSense::mean_powers.
  [[nodiscard]] auto mean_powers() const noexcept { return sense_.mean_powers(); }

 private:
  void feel(const Vec3& position_mm, const Vec3& force_n,
            const Vec3& acceleration_m_s2) noexcept override;

  bool feels_forces_;
  engine::TextureSense sense_;
};

/// By how much a participant's hand differs from the median: a function of its arguments. Source:
/// docs/planning.md, "Differences between participants".
/// \param number  of the participant, from 1
[[nodiscard]] device::HandFactors hand_of_participant(const SubjectModel& subject,
                                                      std::uint64_t seed, std::uint64_t number);

/// A hand above the plane. Draws its path and its starting height.
/// \param factors  the participant's: hand_of_participant
[[nodiscard]] device::SimulatedHand make_exploring_hand(const SubjectModel& subject,
                                                        const PlaneGeometry& plane,
                                                        RandomStream& random,
                                                        const device::HandFactors& factors = {});

/// Puts a subject's hand on a plane, through device, servo and safety chain in virtual time, and
/// senses what the servo did. A function of its arguments; thread-safe. Virtual time and the
/// simulated hand have no faults. A force that is not finite ends the exploration; the features
/// are then those of the ticks before it. Cost: about 0.1 us a tick.
/// \param plane  extent of the explored part: session::StimulusSource::plane
/// \param random  for the path and the starting height
/// \param factors  the participant's: hand_of_participant
/// \return the features without noise, natural logarithms of newtons
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    RandomStream random,
                                                    const device::HandFactors& factors = {});

/// The same with a hand that is at the beginning of its exploration. Copies of one that has
/// foreseen its way explore several fields in less time.
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    device::SimulatedHand hand);

}  // namespace touchtrial::simulation
