// The outlets of the Lab Streaming Layer, on a stand-in for its library.
#include "device/instruments/lab_streaming.hpp"

#include "core/errors.hpp"
#include "device/fakes/fake_lsl.hpp"
#include "device/platform/dynamic_library.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

namespace touchtrial {
namespace {

using Clock = std::chrono::steady_clock;

/// The library that the program under test loads too: both see the same state.
class LoadedLsl {
 public:
  LoadedLsl()
      : library_(TOUCHTRIAL_FAKE_LSL, device::Unload::never, "build the tests"),
        state_(library_.function<fakes::FakeLsl*()>("fake_lsl")()) {
    state_->ahead_s = 0.0;
    state_->makes_outlets = true;
    state_->misuses = 0;
    state_->streams.clear();
    state_->samples.clear();
  }
  [[nodiscard]] fakes::FakeLsl* operator->() const noexcept { return state_; }

 private:
  device::DynamicLibrary library_;
  fakes::FakeLsl* state_;
};

}  // namespace

TEST_CASE("the Lab Streaming Layer gets a stream of markers and one of position and force") {
  const LoadedLsl lsl;
  lsl->ahead_s = 1000.0;
  const Clock::time_point at = Clock::now();
  const double at_s = std::chrono::duration<double>(at.time_since_epoch()).count();
  {
    device::LabStreaming outlets({.library = TOUCHTRIAL_FAKE_LSL, .name = "Lab 3"}, 1000.0);
    outlets.mark("plane-on 7", at);
    outlets.push({1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}, at);
    REQUIRE(lsl->streams.size() == 2);
    CHECK(lsl->streams[0].is_open);
    lsl->ahead_s = 2000.0;
    const device::ClockOffset clock = outlets.read_clock();
    CHECK(clock.offset_s == Approx(2000.0).margin(1.0));
    CHECK(clock.uncertainty_s >= 0.0);
    outlets.mark("contact 7", at);
  }
  CHECK(lsl->streams[0].name == "Lab 3 markers");
  CHECK(lsl->streams[0].type == "Markers");
  CHECK(lsl->streams[0].channels == 1);
  CHECK(lsl->streams[0].rate_hz == 0.0);
  CHECK(lsl->streams[1].name == "Lab 3 hand");
  CHECK(lsl->streams[1].rate_hz == 1000.0);
  CHECK(lsl->streams[1].labels == std::vector<std::string>{"x", "y", "z", "fx", "fy", "fz"});
  CHECK_FALSE(lsl->streams[0].is_open);
  CHECK_FALSE(lsl->streams[1].is_open);
  CHECK(lsl->misuses == 0);
  REQUIRE(lsl->samples.size() == 3);
  CHECK(lsl->samples[0].text == "plane-on 7");
  CHECK(lsl->samples[0].stamp == Approx(at_s + 1000.0).margin(1.0));
  CHECK(lsl->samples[1].values == std::vector<double>{1.0, 2.0, 3.0, 0.1, 0.2, 0.3});
  CHECK(lsl->samples[2].stamp == Approx(at_s + 2000.0).margin(1.0));
}

TEST_CASE("a layer that is absent or makes no outlet is refused with the remedy") {
  CHECK_THROWS_WITH(device::LabStreaming({.library = "libno-such-lsl.so"}, 1000.0),
                    names("libno-such-lsl.so liblsl"));
  const LoadedLsl lsl;
  lsl->makes_outlets = false;
  CHECK_THROWS_AS(device::LabStreaming({.library = TOUCHTRIAL_FAKE_LSL}, 1000.0), DeviceError);
}

}  // namespace touchtrial
