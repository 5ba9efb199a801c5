#include "device/device_link.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

TEST_CASE("a link that has published nothing is not ready, and sends no force") {
  DeviceLink link;
  DeviceSample sample;
  CHECK(link.read(sample) == DeviceStatus::ok);
  CHECK_FALSE(sample.ready);
  CHECK(sample.sequence == 0);
  CHECK(link.force_to_send({}) == Vec3{});
}

TEST_CASE("samples are numbered as they are published") {
  DeviceLink link;
  link.publish({{1.0, 2.0, 3.0}, {}});
  link.publish({{4.0, 5.0, 6.0}, {}});
  DeviceSample sample;
  CHECK(link.read(sample) == DeviceStatus::ok);
  CHECK(sample.position_mm == Vec3{4.0, 5.0, 6.0});
  CHECK(sample.sequence == 2);
}

TEST_CASE("a force that the servo does not renew is sent as zero") {
  DeviceLink link;
  CHECK(link.write({0.0, 0.0, 1.0}, milliseconds(100)) == DeviceStatus::ok);
  CHECK(link.force_to_send(milliseconds(110)) == Vec3{0.0, 0.0, 1.0});
  CHECK(link.force_to_send(milliseconds(111)) == Vec3{});
}

TEST_CASE("a halted link sends zero whatever is written, until it is re-armed") {
  DeviceLink link;
  link.halt();
  CHECK(link.write({1.0, 0.0, 0.0}, {}) == DeviceStatus::ok);
  CHECK(link.force_to_send({}) == Vec3{});
  link.rearm();
  CHECK(link.force_to_send({}) == Vec3{1.0, 0.0, 0.0});
}

TEST_CASE("the first fault of a link stays, and no force follows it") {
  DeviceLink link;
  link.fail(DeviceFault::warm_motors);
  link.fail(DeviceFault::link_lost);
  DeviceSample sample;
  CHECK(link.fault() == DeviceFault::warm_motors);
  CHECK(link.read(sample) == DeviceStatus::fault);
  CHECK(link.write({1.0, 0.0, 0.0}, {}) == DeviceStatus::fault);
  CHECK(link.force_to_send({}) == Vec3{});
}

}  // namespace
}  // namespace touchtrial
