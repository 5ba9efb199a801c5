#include "device/safety/slew_limit.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a force follows by one step a tick, straight towards where it shall be") {
  device::SlewLimit slew(1000.0, 0.001);
  CHECK(slew.towards({3.0, 4.0, 0.0}).x == Approx(0.6));
  CHECK(slew.towards({3.0, 4.0, 0.0}).y == Approx(1.6));
  for (int tick = 0; tick < 2; ++tick) static_cast<void>(slew.towards({3.0, 4.0, 0.0}));
  CHECK(norm(slew.sent_n()) == Approx(4.0));
  CHECK(slew.towards({3.0, 4.0, 0.0}) == Vec3{3.0, 4.0, 0.0});
}

TEST_CASE("a small change passes to the last bit") {
  device::SlewLimit slew(1000.0, 0.001);
  CHECK(slew.towards({0.1, 0.2, 0.3}) == Vec3{0.1, 0.2, 0.3});
  CHECK(slew.towards({0.3, 0.1, 0.7}) == Vec3{0.3, 0.1, 0.7});
}

TEST_CASE("the way of a fault is no slope") {
  device::SlewLimit slew(1000.0, 0.001);
  for (int tick = 0; tick < 5; ++tick) static_cast<void>(slew.towards({0.0, 0.0, 3.0}));
  slew.drop();
  CHECK(slew.sent_n() == Vec3{});
  CHECK(slew.towards({0.0, 0.0, 3.0}).z == Approx(1.0));
}

TEST_CASE("without a limit every force passes") {
  device::SlewLimit slew(std::numeric_limits<double>::infinity(), 0.001);
  CHECK(slew.towards({0.0, -50.0, 0.0}) == Vec3{0.0, -50.0, 0.0});
}

}  // namespace
}  // namespace touchtrial
