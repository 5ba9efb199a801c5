#include "device/acceptance/certificate.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <string>

namespace touchtrial {
namespace {

using device::Certificate;

Certificate passed_certificate() {
  Certificate certificate{.driver = "falcon",
                          .model = "Novint Falcon",
                          .serial = "F1",
                          .firmware = "1",
                          .program = "0.1.0",
                          .made = std::chrono::sys_days(std::chrono::year(2026) / 2 / 28) +
                                  std::chrono::hours(9) + std::chrono::seconds(5),
                          .rest = device::RestFigures{0.01, 0.02},
                          .step_mm = device::Measured{0.038, 0.002}};
  for (const device::DeviceAxis axis : device::kDeviceAxes) {
    device::AxisResult result{.axis = axis, .plus = device::PushResult{0.4, true, 2.0, 0.1}};
    result.minus = result.plus;
    result.weight = device::WeighResult{0.980665, 1.01, 0.02};
    result.load_n = 0.1;
    result.friction_n = device::Measured{0.3, 0.05};
    result.mass_kg = device::Measured{0.15, 0.02};
    result.delay_ms = device::Measured{1.5, 0.5};
    certificate.axes.push_back(result);
  }
  certificate.wall = device::WallResult{0.6, 0.78, "oscillation"};
  certificate.not_measured = {{"mass and delay on axis x", "left out"}};
  return certificate;
}

device::DeviceInfo the_falcon() {
  device::DeviceInfo info{"falcon", "F1", 4.9};
  info.model = "Novint Falcon";
  info.firmware = "1";
  return info;
}

}  // namespace

TEST_CASE("an acceptance's certificate is read as it was written, with its hash") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  const Certificate certificate = passed_certificate();
  REQUIRE(certificate.passed());
  const std::string text = device::certificate_json(certificate);
  replace_file(path, text);
  const device::HashedCertificate read = device::read_certificate(path);
  CHECK(device::certificate_json(read.certificate) == text);
  CHECK(read.certificate.made == certificate.made);
  CHECK(read.hash == sha256_of_file(path));
  CHECK(text.find("2026-02-28T09:00:05Z") != std::string::npos);
}

TEST_CASE("an acceptance's certificate that was changed by hand is refused with the place") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = device::certificate_json(passed_certificate());
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    replace_file(path, text);
    return message_of<StudyError>([&] { return device::read_certificate(path); });
  };
  CHECK_THAT(changed("\"passed\": true", "\"passed\": false"), holds_text("/passed"));
  CHECK_THAT(changed("2026-02-28", "2026-02-30"), holds_text("/made"));
  CHECK_THAT(changed("acceptance 3", "acceptance 9"), holds_text("/kind"));
  CHECK_THAT(changed("\"serial\"", "\"cereal\""), holds_text("/cereal"));
  CHECK_THAT(changed("\"measured_n\": 1.01", "\"measured_n\": 1.31"), holds_text("/axes/0/scale"));
  CHECK_THAT(changed("\"along_mm\": 2.0", "\"along_mm\": -2.0"), holds_text("/passed"));
  CHECK_THAT(changed("\"noise_mm\": 0.01", "\"noise_mm\": 0.2"), holds_text("/passed"));
  CHECK_THAT(changed("\"noise_mm\": 0.01", "\"noise_mm\": -1"), holds_text("/rest/noise_mm"));
  CHECK_THAT(changed("\"expected_n\": 0.980665", "\"expected_n\": 0"),
             holds_text("/axes/0/weight/expected_n"));
  CHECK_THAT(changed("\"value\": 0.15", "\"value\": -0.15"), holds_text("/axes/0/mass_kg/value"));
  CHECK_THAT(changed("\"stable_n_per_mm\": 0.6", "\"stable_n_per_mm\": 0.9"),
             holds_text("/wall/stable_n_per_mm"));
  CHECK_THAT(changed("\"axis\": \"x\"", "\"axis\": \"y\""), holds_text("/axes/1/axis"));
}

TEST_CASE("a certificate belongs to the scales with which it was made") {
  Certificate certificate = passed_certificate();
  certificate.scale.force = {1.0, 1.25, 1.0};
  const auto soon = certificate.made + std::chrono::days(30);
  CHECK_THAT(message_of<DeviceError>(
                 [&] { return device::check_certificate(certificate, the_falcon(), soon); }),
             names("1.25 falcon"));
  device::DeviceInfo scaled = the_falcon();
  scaled.scale = certificate.scale;
  CHECK(device::check_certificate(certificate, scaled, soon).empty());
}

TEST_CASE("a force that is off names the scale that puts it right") {
  Certificate certificate = passed_certificate();
  certificate.scale.force = {1.0, 1.25, 1.0};
  certificate.axes[0].weight = device::WeighResult{1.2, 1.0, 0.02};  // y is the first
  REQUIRE(certificate.failures().size() == 1);
  CHECK_THAT(certificate.failures().front(), names("y force_scale 1.50"));
}

TEST_CASE("a certificate of the former format is refused with the command that makes a new one") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  replace_file(path, R"({"kind": "touchtrial device acceptance 2", "observed": []})");
  CHECK_THAT(message_of<StudyError>([&] { return device::read_certificate(path); }),
             names("touchtrial device accept"));
}

TEST_CASE("an acceptance is valid for its own device only, if it passed and was no rehearsal") {
  const Certificate certificate = passed_certificate();
  const auto soon = certificate.made + std::chrono::days(30);
  CHECK(device::check_certificate(certificate, the_falcon(), soon).empty());
  const auto refusal = [&](const Certificate& given, const device::DeviceInfo& info) {
    return message_of<DeviceError>([&] { return device::check_certificate(given, info, soon); });
  };
  device::DeviceInfo other = the_falcon();
  other.serial = "F2";
  CHECK_THAT(refusal(certificate, other), names("F2 falcon"));
  other = the_falcon();
  other.model = "Novint Falcon 2";
  CHECK_THAT(refusal(certificate, other), holds_text("Novint Falcon 2"));
  Certificate emulated = certificate;
  emulated.emulated = "falcon";
  CHECK_THAT(refusal(emulated, the_falcon()), names("falcon"));
  Certificate failed = certificate;
  failed.axes[1].plus->along_mm = -2.0;
  CHECK_THAT(refusal(failed, the_falcon()), names(std::string(name_of(failed.axes[1].axis))));
  failed = certificate;
  failed.axes.pop_back();
  CHECK_FALSE(failed.passed());
}

TEST_CASE("a delay must be shown to be below its limit by all of its interval") {
  const auto first_failure = [](const std::optional<device::Measured>& delay_ms) {
    Certificate certificate = passed_certificate();
    certificate.not_measured = {{"delay on axis y", "no bend"}};
    certificate.axes[0].delay_ms = delay_ms;
    const auto failures = certificate.failures();
    return failures.empty() ? std::string() : failures.front();
  };
  CHECK(first_failure(device::Measured{4.0, 0.9}).empty());
  CHECK(first_failure(device::Measured{3.0, 2.0}).empty());
  CHECK_THAT(first_failure(device::Measured{4.8, 1.2}), names("y 4.8 5"));
  CHECK_THAT(first_failure(device::Measured{-1.25, 5.5}), names("y 5"));
  CHECK(device::verdict_on_delay({-1.25, 5.5}) == device::DelayVerdict::unclear);
  CHECK_THAT(first_failure(device::Measured{13.0, 9.0}), names("y 5"));
  CHECK(device::verdict_on_delay({13.0, 9.0}) == device::DelayVerdict::unclear);
  CHECK_THAT(first_failure(device::Measured{8.0, 0.6}), names("y 5"));
  CHECK_THAT(first_failure(std::nullopt), names("y") && holds_text("no bend"));
  Certificate left_out = passed_certificate();
  left_out.axes[0].delay_ms.reset();
  left_out.axes[0].delay_left_out = true;
  CHECK(left_out.passed());
  CHECK(device::certificate_json(left_out).find("\"delay_left_out\": true") != std::string::npos);
}

TEST_CASE("a number that is written like its limit does not exceed it") {
  Certificate certificate = passed_certificate();
  certificate.step_mm = device::Measured{0.1 + 1e-12, 0.005};
  certificate.axes[0].weight = device::WeighResult{1.1002, 1.0, 0.02};
  CHECK(certificate.passed());
  certificate.step_mm = device::Measured{0.101, 0.005};
  CHECK_FALSE(certificate.passed());
  certificate = passed_certificate();
  certificate.axes[0].weight = device::WeighResult{1.106, 1.0, 0.02};
  CHECK_FALSE(certificate.passed());
}

TEST_CASE("a device whose softest wall swings fails") {
  Certificate certificate = passed_certificate();
  certificate.wall = device::WallResult{0.0, 0.1, "oscillation"};
  REQUIRE(certificate.failures().size() == 1);
  CHECK_THAT(certificate.failures().front(), names("0.1 N/mm"));
}

TEST_CASE("an acceptance that is half a year old or of another firmware causes a warning") {
  const Certificate certificate = passed_certificate();
  const auto check = [&](int days, const device::DeviceInfo& info) {
    return device::check_certificate(certificate, info, certificate.made + std::chrono::days(days));
  };
  CHECK(check(180, the_falcon()).empty());
  CHECK_THAT(check(200, the_falcon()), names("200"));
  device::DeviceInfo newer = the_falcon();
  newer.firmware = "2";
  CHECK_FALSE(check(1, newer).empty());
}

TEST_CASE("a certificate from the future is refused beyond the tolerance of clocks") {
  const Certificate certificate = passed_certificate();
  const auto before = [&](int hours) { return certificate.made - std::chrono::hours(hours); };
  CHECK(device::check_certificate(certificate, the_falcon(), before(23)).empty());
  CHECK_THAT(message_of<DeviceError>(
                 [&] { return device::check_certificate(certificate, the_falcon(), before(25)); }),
             names("2026-02-28T09:00:05Z"));
}

TEST_CASE("long names of a certificate are cut in its refusals") {
  Certificate certificate = passed_certificate();
  certificate.model = std::string(3000, 'm');
  const auto refusal = [&] {
    return message_of<DeviceError>(
        [&] { return device::check_certificate(certificate, the_falcon(), certificate.made); });
  };
  CHECK(refusal().size() < 400);
  certificate.emulated = std::string(3000, 'e');
  CHECK(refusal().size() < 400);
}

TEST_CASE("a study's wall must be softer than one that swung in the acceptance") {
  Certificate certificate = passed_certificate();
  const auto refusal = [&](double n_per_mm) {
    return message_of<DeviceError>([&] { device::require_stable(certificate, n_per_mm); });
  };
  device::require_stable(certificate, 0.6);
  device::require_stable(certificate, 0.7);
  CHECK_THAT(refusal(0.8), names("0.78 0.6"));
  // Where even the softest wall swung there is no advice.
  certificate.wall = device::WallResult{0.0, 0.1, "oscillation"};
  CHECK_THAT(refusal(0.4), names("0.1") && !names("0.0"));
}

}  // namespace touchtrial
