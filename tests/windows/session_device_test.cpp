#include "app/run/session_device.hpp"

#include "core/errors.hpp"
#include "study/deviation_codes.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

device::DeviceInfo felt() {
  return {.name = "falcon"};
}

device::SchedulingObtained ordinary() {
  return {.reason = "SCHED_FIFO (Operation not permitted)"};
}

TEST_CASE("a session with force and without real time is refused with the two lines that mend it") {
  const auto enter = [] { (void)app::lateness_entry(felt(), ordinary(), false); };
  CHECK_THROWS_AS(enter(), DeviceError);
  CHECK_THROWS_WITH(enter(), holds_text("rtprio 99\"") && holds_text("memlock unlimited\"") &&
                                 holds_text("/etc/security/limits.d/touchtrial.conf") &&
                                 holds_text("--allow-late") && !holds_text("\n"));
}

TEST_CASE("a late session that is wanted all the same is recorded by a code of the program's") {
  const auto late = app::lateness_entry(felt(), ordinary(), true);
  REQUIRE(late);
  CHECK(late->kind == session::ExperimenterRequest::Kind::deviation);
  CHECK(late->code == "no-real-time");
  CHECK(study::is_deviation_code(late->code));
  CHECK_THAT(late->text, holds_text("SCHED_FIFO (Operation"));
}

TEST_CASE("a punctual servo, a mouse and a simulated hand need no permission") {
  device::SchedulingObtained punctual;
  punctual.policy = device::SchedulingPolicy::fifo;
  CHECK_FALSE(app::lateness_entry(felt(), punctual, false));
  device::DeviceInfo mouse = felt();
  mouse.visual = true;
  CHECK_FALSE(app::lateness_entry(mouse, ordinary(), false));
  device::DeviceInfo simulated = felt();
  simulated.simulated = true;
  CHECK_FALSE(app::lateness_entry(simulated, ordinary(), false));
}

}  // namespace
}  // namespace touchtrial
