// touchtrial device test, device accept and device bring-up as people and scripts run them. Every
// test waits for the program's output, never for a time, and tolerates a machine that stalls: the
// program must then end with a fault.
#include "app/device_folder.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <sstream>

using namespace touchtrial;
using touchtrial::testing::ChildProcess;

namespace {

json dhd_settings() {
  return {{"dhd", {{"library", TOUCHTRIAL_FAKE_DHD}, {"workspace_mm", {160, 160, 110}}}}};
}

/// Down onto a plane within half a second, then along it, 1 mm deep, for 2.5 s.
std::string recorded_stroke() {
  std::ostringstream csv;
  csv << "time_s,x_mm,y_mm,z_mm\n";
  for (int ms = 0; ms < 3000; ++ms) {
    csv << 0.001 * ms << ',' << 30.0 + 0.01 * ms << ",50," << std::max(-1.0, 4.0 - 0.01 * ms)
        << '\n';
  }
  return csv.str();
}

/// A test of the simulated device that somebody has to end.
struct EndlessTest : DeviceFolder {
  EndlessTest() { REQUIRE(program.says("wall  ")); }
  ChildProcess program = start("test simulated --seconds 3000");
};

/// What `device accept` prints before its first run.
constexpr const char* kFirstPrompt = "[Enter";

}  // namespace

TEST_CASE("device test goes from wall to texture in one run, and the hand stays on the plane") {
  const json test =
      json::parse(succeeded(DeviceFolder().device("test simulated --seconds 2 --json")).output);
  CHECK(test.at("driver") == "simulated");
  CHECK(test.at("scheduling").at("policy").is_string());
  CHECK(test.at("scheduling").at("memory_locked").is_boolean());
  const json& run = test.at("run");
  CHECK(run.at("end") == "time_limit");
  CHECK(run.at("fault") == "none");
  CHECK(run.at("rate_hz") > 0.0);
  CHECK(run.at("overruns") >= 0);
  CHECK(run.at("lateness_us").at("worst") >= run.at("lateness_us").at("p50"));
  // 2 s and the fade of 0.1 s; ticks that a busy machine misses are left out.
  CHECK(run.at("ticks").get<int>() + run.at("overruns").get<int>() == 2100);
  REQUIRE(test.at("phases").size() == 2);
  for (const json& phase : test.at("phases")) {
    CAPTURE(phase.dump());
    CHECK(phase.at("contact_s") > 0.0);
    CHECK(phase.at("greatest_force_n") > 0.3);
  }
  CHECK(test.at("phases").at(1).at("phase") == "texture");
  CHECK(test.at("fault_record") == "");
}

TEST_CASE("device test can show only the wall, and has a summary for people") {
  const ProgramResult result =
      succeeded(DeviceFolder().device("test simulated --seconds 0.5 --wall-only"));
  CHECK_THAT(result.output, holds_text("wall") && !holds_text("texture"));
}

TEST_CASE("device test --watch shows readings without a force") {
  const DeviceFolder folder;
  const ProgramResult result =
      succeeded(folder.device("test simulated --watch --seconds 0.5 --json"));
  const json phases = json::parse(result.output).at("phases");
  REQUIRE(phases.size() == 1);
  CHECK(phases.at(0).at("phase") == "watch");
  CHECK(phases.at(0).at("ticks") > 0);
  CHECK(phases.at(0).at("greatest_force_n") == 0.0);
  check_refused(folder.device("test simulated --watch --wall-only"), 2, {"--watch", "--wall-only"});
}

TEST_CASE("device test ends well at q and at a space") {
  const char* const key = GENERATE("q", " ");
  EndlessTest test;
  test.program.write(key);
  CHECK(test.program.finish() == 0);
  CHECK_FALSE(test.program.output().empty());
}

TEST_CASE("device test that a signal ends says so, and exits with the code that a shell expects") {
  const auto [signal, name] =
      GENERATE(table<int, std::string>({{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}));
  EndlessTest test;
  test.program.close_input();  // which ends nothing
  test.program.send_signal(signal);
  CHECK(test.program.finish() == 128 + signal);
  CHECK_THAT(test.program.output(), holds_text(name));
  CHECK_FALSE(fs::exists(test.in("device-test-simulated-fault.csv")));
}

TEST_CASE("device test replays the recording that the settings name, to its end") {
  const DeviceFolder folder(json{{"replay", {{"trace", "stroke.csv"}}}});
  replace_file(folder.path() / "stroke.csv", recorded_stroke());
  const json test =
      json::parse(succeeded(folder.device("test replay --seconds 600 --json")).output);
  CHECK(test.at("run").at("end") == "hand_stopped");
  CHECK(test.at("run").at("contact_s") > 0.0);
  REQUIRE(test.at("phases").size() == 1);
  CHECK(std::abs(test.at("phases").at(0).at("greatest_force_n").get<double>() - 0.4) < 1e-9);
}

TEST_CASE("device test refuses what it cannot open or read with one line and a remedy") {
  const DeviceFolder folder;
  check_refused(folder.device("test simulatd"), 2, {"simulatd", "simulated"});
  check_refused(folder.device("test replay"), 1, {"replay.trace"});
  check_refused(folder.device("test simulated --seconds nan"), 2, {"--seconds", "nan"});
  check_refused(folder.device("test simulated --rate nan"), 2, {"--rate", "nan"});
}

TEST_CASE("device list and test use the library that the settings name") {
  const DeviceFolder folder(dhd_settings());
  bool found = false;
  const json devices = json::parse(succeeded(folder.device("list --json")).output).at("devices");
  for (const json& device : devices) {
    if (device.at("driver") != "dhd") continue;
    found = true;
    CHECK(device.at("ready") == true);
    CHECK(device.at("model") == "omega.3");
  }
  CHECK(found);

  ChildProcess test = folder.start("test dhd --seconds 0.5");
  const int code = test.finish();
  INFO(test.output());
  CHECK_THAT(test.output(), holds_text("dhd: omega.3, serial 4242"));
  const bool stood_still = code == 1 && fs::exists(folder.in("device-test-dhd-fault.csv"));
  CHECK((code == 0 || stood_still));
}

TEST_CASE(
    "device initialise asks before it moves anything, and names manual homing as the alternative") {
  const DeviceFolder folder(dhd_settings());
  check_refused(folder.device("initialise simulated"), 2, {"touchtrial device test simulated"});
  check_refused(folder.device("initialise dhd"), 2, {"--yes"});
  check_refused(folder.device("initialise dhd --yes"), 1, {"libdrd.so"});
}

TEST_CASE("device accept requires motors, every answer, and a device or a model") {
  const DeviceFolder folder(dhd_settings());
  const ProgramResult simulated = folder.device("accept simulated");
  CHECK(simulated.exit_code == 1);
  CHECK_FALSE(simulated.errors.empty());
  check_refused(folder.device("accept"), 2, {"--emulate"});
  check_refused(folder.device("accept --emulate falcn"), 2, {"falcn"});
  const ProgramResult silent = folder.device("accept dhd");
  CHECK(silent.exit_code == 2);
  CHECK_THAT(silent.errors, holds_text(kFirstPrompt));
  CHECK_FALSE(fs::exists(folder.in("dhd-certificate.json")));
}

TEST_CASE("device accept ends at q and at a signal, without a certificate") {
  const DeviceFolder folder(dhd_settings());
  ChildProcess quit = folder.start("accept dhd");
  REQUIRE(quit.says(kFirstPrompt));
  quit.write("q\n");
  CHECK(quit.finish() == 1);
  for (const int signal : {SIGTERM, SIGINT}) {
    ChildProcess ended = folder.start("accept dhd");
    REQUIRE(ended.says(kFirstPrompt));
    ended.send_signal(signal);
    CHECK(ended.finish() == 128 + signal);
    CHECK_THAT(ended.output(), holds_text("SIG"));
  }
  CHECK_FALSE(fs::exists(folder.in("dhd-certificate.json")));
}

TEST_CASE("device accept that leaves out every step writes a certificate that fails") {
  const DeviceFolder folder(dhd_settings());
  ChildProcess skipping = folder.start("accept dhd");
  skipping.write("s\nwhat\ns\ns\n");
  const int code = skipping.finish();
  INFO(skipping.output());
  CHECK(code == 1);
  CHECK_THAT(skipping.output(), holds_text("Enter"));
  const json certificate = folder.object_in("dhd-certificate.json");
  CHECK(certificate.at("passed") == false);
  CHECK(certificate.at("driver") == "dhd");
  CHECK(certificate.at("emulated") == "");
  CHECK(certificate.at("not_measured").size() >= 3);
}

TEST_CASE("device accept ignores input typed before a prompt") {
  const DeviceFolder folder(dhd_settings());
  TerminalRun run(folder.words("accept dhd --certificate @c.json"));
  run.answer("[Enter, s, q] ", "s\r\r\r\r\r\r\r");
  run.answer("12 s", "q");
  CHECK(run.finish() == 1);
}

/// Holds Enter at the prompt of a run, and begins that run by pressing Enter anew.
/// \return false if nothing can be said, because the machine stalled: for so long that a held Enter
///   seemed to be pressed anew, or in the run, which then ended with a fault
bool only_a_fresh_enter_begins_the_run() {
  constexpr const char* kLiveLine = "\x1b[K";  // ends every line that overwrites itself
  const DeviceFolder folder(dhd_settings());
  TerminalRun run(folder.words("accept dhd --skip rest --certificate @c.json"));
  run.hold_enter("[Enter, s, q] ", std::chrono::seconds(2));
  std::chrono::milliseconds pause{1500};
  if (run.shows(kLiveLine, pause)) return false;
  // Something about Enter after the prompt: release it.
  if (run.shown().rfind("Enter") <= run.shown().rfind("[Enter") + 1) return false;
  // Where the program takes the held ones late, the first fresh one comes too soon after them.
  do {
    if (run.ended()) return false;
    run.press("\r");
    pause *= 2;
  } while (!run.shows(kLiveLine, pause));
  run.press("\x03");
  const int code = run.finish();
  if (run.shown().find("the device failed") != std::string::npos) return false;
  CHECK(code == 128 + SIGINT);
  return true;
}

TEST_CASE("device accept counts a held Enter once, and continues at a new press") {
  int attempts = 1;
  while (!only_a_fresh_enter_begins_the_run()) REQUIRE(++attempts <= 10);
}

TEST_CASE("device accept loses no answer after that to a reset") {
  const DeviceFolder folder(json{{"openhaptics", {{"library", TOUCHTRIAL_FAKE_HD}}}});
  ChildProcess program = folder.start("accept openhaptics", {"FAKE_HD_NEEDS_RESET=1"});
  program.write("\nq\n");
  program.close_input();
  CHECK(program.finish() == 1);
  CHECK_THAT(program.output(), holds_text("Enter"));
}

TEST_CASE("device accept refuses files that it could not write before it opens the device") {
  const DeviceFolder folder(dhd_settings());
  const auto accept = [&](const std::string& certificate) {
    return folder.device("accept dhd --certificate @" + certificate);
  };
  check_refused(accept("c.html"), 2, {"c.html", ".json"});
  check_refused(accept("no/such/c.json"), 1, {"c.json"});
  make_folder(folder.path() / "c.html");
  check_refused(accept("c.json"), 1, {"c.html", "--force"});
  check_refused(accept("devices.json"), 2, {"devices.json"});
  CHECK_FALSE(fs::exists(folder.in("c.json.trial")));
}

TEST_CASE("device accept never replaces the model that it rehearses on") {
  const DeviceFolder folder;
  const std::string model = R"({"name": "modelled", "mass_kg": 0.1, "max_force_n": 4})";
  replace_file(folder.path() / "mine-model.json", model);
  check_refused(
      folder.device("accept --emulate @mine-model.json --certificate @mine-certificate.json"), 2,
      {"mine-model.json", "--certificate"});
  CHECK(content(folder.in("mine-model.json")) == model);
  // Nor does a rehearsal on what a rehearsal wrote.
  CHECK(folder.start("accept --emulate mine-model.json --skip push").finish() == 1);
  const std::string written = content(folder.in("emulated-modelled-model.json"));
  CHECK(json::parse(written).at("name") == "emulated-modelled");
  CHECK(folder.start("accept --emulate emulated-modelled-model.json --skip push").finish() == 1);
  CHECK(content(folder.in("emulated-modelled-model.json")) == written);
}

TEST_CASE("device accept rehearses on a device model, and says that it proves no device") {
  const DeviceFolder folder;
  ChildProcess rehearsal = folder.start("accept --emulate falcon");
  const int code = rehearsal.finish();
  INFO(rehearsal.output());
  REQUIRE(code == 0);
  CHECK_THAT(rehearsal.output(), holds_text("REHEARSAL"));
  json certificate = folder.object_in("emulated-falcon-certificate.json");
  CHECK(certificate.at("emulated") == "falcon");
  CHECK(certificate.at("passed") == true);
  CHECK_THAT(content(folder.in("emulated-falcon-certificate.html")),
             holds_text("REHEARSAL") && holds_text("<svg"));
  const json model = folder.object_in("emulated-falcon-model.json");
  CHECK(model.at("mass_kg") > 0.1);
  CHECK(model.at("provenance").at("mass_kg").at("confidence") == "derived");

  // As if a device had passed: a later acceptance keeps this certificate, and one that failed is
  // not kept.
  certificate["emulated"] = "";
  const DeviceFolder lab(dhd_settings());
  replace_file(lab.path() / "dhd-certificate.json", certificate.dump());
  for (int time = 0; time < 2; ++time) {
    ChildProcess skipping = lab.start("accept dhd --force");
    skipping.write("s\ns\ns\n");
    CHECK(skipping.finish() == 1);
    CHECK(lab.object_in("dhd-certificate.json").at("passed") == false);
    CHECK(content(lab.in("dhd-certificate.json.1")) == certificate.dump());
    CHECK_FALSE(fs::exists(lab.in("dhd-certificate.json.2")));
  }
}

TEST_CASE("device accept refuses a broken emulated device") {
  const DeviceFolder folder;
  replace_file(folder.path() / "broken.json",
               R"({"name": "broken", "mass_kg": 0.1, "coulomb_n": 0.2, "max_force_n": 4,
                   "planted": {"force_sign_scale": [1, 1, -1]}})");
  const ProgramResult result =
      folder.device("accept --emulate @broken.json --certificate @c.json --json");
  INFO(result.errors);
  CHECK(result.exit_code == 1);
  const json certificate = json::parse(result.output);
  CHECK(certificate.at("passed") == false);
  CHECK_THAT(certificate.at("failures").dump(), holds_text("axis z") && holds_text("sign"));
}

TEST_CASE("device bring-up saves its results at q and at a signal, and lists what was not done") {
  const bool by_signal = GENERATE(false, true);
  const DeviceFolder folder(dhd_settings());
  ChildProcess program = folder.start("bring-up omega");
  REQUIRE(program.says("[Enter"));
  program.write("s\n");
  REQUIRE(program.says(" 5 cm"));
  if (by_signal) {
    program.send_signal(SIGTERM);
  } else {
    program.write("q\n");
  }
  const int code = program.finish();
  INFO(program.output());
  CHECK(code == (by_signal ? 128 + SIGTERM : 1));
  const json file = folder.object_in("dhd-bring-up.json");
  CHECK(file.at("driver") == "dhd");
  CHECK(file.at("ended") == "stopped");
  CHECK(file.at("library") == "3.17.5.1900");
  CHECK(file.at("steps").at("rest") == "left_out");
  CHECK(file.at("steps").at("ways") == "interrupted");
  CHECK(file.at("steps").at("questions") == "not_reached");
  CHECK(file.dump().find("4242") == std::string::npos);
}

TEST_CASE("device bring-up saves its results at the end of the input") {
  const DeviceFolder folder(dhd_settings());
  CHECK(folder.device("bring-up dhd --out @dhd-bring-up.json").exit_code == 2);
  CHECK(folder.object_in("dhd-bring-up.json").at("steps").at("rest") == "interrupted");
}

TEST_CASE("device bring-up that leaves out every step asks its questions, and replaces nothing") {
  const DeviceFolder folder(dhd_settings());
  ChildProcess skipping = folder.start("bring-up dhd");
  // rest, three ways, six pushes, steps, range, program, cable; then five questions.
  skipping.write("s\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\n9\n1\n\n\n\n\n");
  const int code = skipping.finish();
  INFO(skipping.output());
  CHECK(code == 0);
  CHECK(folder.object_in("dhd-bring-up.json").at("ended") == "complete");
  // The library's file is named libfake_dhd.so.
  CHECK_FALSE(folder.object_in("dhd-bring-up.json").at("stand_in").get<std::string>().empty());
  // Nothing is replaced.
  check_refused(folder.device("bring-up dhd --out @dhd-bring-up.json"), 1, {"--out"});
}

TEST_CASE("device bring-up lists the unverified facts") {
  const DeviceFolder folder;
  CHECK(folder.printed("device bring-up --facts --json").size() == 4);
  CHECK(folder.printed("device bring-up omega --facts --json").size() == 1);
  CHECK(folder.device("bring-up simulated").exit_code == 1);
  CHECK(folder.device("bring-up").exit_code == 2);
}
