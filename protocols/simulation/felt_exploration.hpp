/// \file A simulated hand's exploration of a plane and its felt features, without session and
/// trace.
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

/// A subject's sense of touch: it feels the servo's forces, or the accelerations of the tip.
class HandSense final : private device::TipSense {
 public:
  explicit HandSense(const SubjectModel& subject);
  HandSense(const HandSense&) = delete;
  HandSense& operator=(const HandSense&) = delete;
  ~HandSense() override = default;

  /// Restarts with a hand at the beginning of its exploration; the hand must not outlive this.
  void begin(device::SimulatedHand& hand, const PlaneGeometry& plane);
  /// Adds a sample of the servo, in the time of TextureSense.
  void feel(const device::ServoSample& sample) noexcept;
  /// Features without noise (see FeltDecision). Call only after the last tick.
  [[nodiscard]] engine::FeltFeatures features() const noexcept { return sense_.features(); }
  /// TextureSense::mean_powers.
  [[nodiscard]] auto mean_powers() const noexcept { return sense_.mean_powers(); }

 private:
  void feel(const Vec3& position_mm, const Vec3& force_n,
            const Vec3& acceleration_m_s2) noexcept override;

  bool feels_forces_;
  engine::TextureSense sense_;
};

/// Factors by which a participant's hand differs from the median, determined by the arguments.
/// Source: docs/planning.md, "Differences between participants".
/// \param number  the participant's number, from 1
[[nodiscard]] device::HandFactors hand_of_participant(const SubjectModel& subject,
                                                      std::uint64_t seed, std::uint64_t number);

/// Creates a hand above the plane with a random path and starting height.
/// \param factors  from hand_of_participant
[[nodiscard]] device::SimulatedHand make_exploring_hand(const SubjectModel& subject,
                                                        const PlaneGeometry& plane,
                                                        RandomStream& random,
                                                        const device::HandFactors& factors = {});

/// Runs an exploration through device, servo and safety chain in virtual time, and senses it. The
/// result depends only on the arguments; thread-safe. Virtual time and the simulated hand have no
/// faults, but a force that is not finite ends the exploration; the features are then those of the
/// ticks before it. Takes about 0.1 us per tick.
/// \param plane  extent of the explored area: session::StimulusSource::plane
/// \param random  for the path and the starting height
/// \param factors  from hand_of_participant
/// \return the features without noise, natural logarithms of newtons
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    RandomStream random,
                                                    const device::HandFactors& factors = {});

/// Overload with a hand at the beginning of its exploration. Copies of a hand with a precomputed
/// path (SimulatedHand::precompute) explore several fields in less time.
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    device::SimulatedHand hand);

}  // namespace touchtrial::simulation
