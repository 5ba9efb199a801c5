#include "device/drivers/device_link.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

TEST_CASE("a link that has published nothing is not ready, and sends no force") {
  device::DeviceLink link;
  device::DeviceSample sample;
  CHECK(link.read(sample) == device::DeviceStatus::ok);
  CHECK_FALSE(sample.ready);
  CHECK(sample.sequence == 0);
  CHECK(link.force_to_send({}) == Vec3{});
}

TEST_CASE("samples are numbered as they are published") {
  device::DeviceLink link;
  link.publish({{1.0, 2.0, 3.0}, {}});
  link.publish({{4.0, 5.0, 6.0}, {}});
  device::DeviceSample sample;
  CHECK(link.read(sample) == device::DeviceStatus::ok);
  CHECK(sample.position_mm == Vec3{4.0, 5.0, 6.0});
  CHECK(sample.sequence == 2);
}

TEST_CASE("a force that the servo does not renew is sent as zero") {
  device::DeviceLink link;
  CHECK(link.write({0.0, 0.0, 1.0}, milliseconds(100)) == device::DeviceStatus::ok);
  CHECK(link.force_to_send(milliseconds(110)) == Vec3{0.0, 0.0, 1.0});
  CHECK(link.force_to_send(milliseconds(111)) == Vec3{});
}

TEST_CASE("a halted link sends zero whatever is written, until it is re-armed") {
  device::DeviceLink link;
  link.halt();
  CHECK(link.write({1.0, 0.0, 0.0}, {}) == device::DeviceStatus::ok);
  CHECK(link.force_to_send({}) == Vec3{});
  link.rearm();
  CHECK(link.force_to_send({}) == Vec3{1.0, 0.0, 0.0});
}

TEST_CASE("the first fault of a link stays, and no force follows it") {
  device::DeviceLink link;
  link.fail(device::DeviceFault::warm_motors);
  link.fail(device::DeviceFault::link_lost);
  device::DeviceSample sample;
  CHECK(link.fault() == device::DeviceFault::warm_motors);
  CHECK(link.read(sample) == device::DeviceStatus::fault);
  CHECK(link.write({1.0, 0.0, 0.0}, {}) == device::DeviceStatus::fault);
  CHECK(link.force_to_send({}) == Vec3{});
}

}  // namespace
}  // namespace touchtrial
