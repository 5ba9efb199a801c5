/// \file A participant who knows the textures, and whose hand moves a device by itself.
#pragma once

#include "device/drivers/falcon/emulator/hand_on_falcon.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/simulation/simulated_participant.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace touchtrial {

class PersonWithHand final : public simulation::PromptParticipant {
 public:
  /// All must outlive this.
  PersonWithHand(simulation::SimulatedParticipant& mind, device::falcon::HandOnFalcon& hand,
                 session::DeviceStation& station)
      : mind_(mind), hand_(hand), station_(station) {}

  void see_pictures(const std::vector<std::string>& labels) override { mind_.see_pictures(labels); }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    ++begun;
    explored_ = hand_.explorations();
    hand_.explore(static_cast<const device::SimulatedHand&>(mind_.begin_exploring(plane)));
    return station_.device();
  }
  void while_exploring(device::ServoControl& servo) override {
    if (hand_.explorations() > explored_) servo.finish();
  }
  void feel(const device::ServoSample& sample) noexcept override { mind_.feel(sample); }
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    const simulation::ParticipantAnswer answer = mind_.answer();
    named.push_back(answer.position);
    return answer;
  }

  std::vector<int> named;     ///< every choice, in order
  std::atomic<int> begun{0};  ///< explorations

 private:
  simulation::SimulatedParticipant& mind_;
  device::falcon::HandOnFalcon& hand_;
  session::DeviceStation& station_;
  int explored_ = 0;
};

}  // namespace touchtrial
