// touchtrial device test, device accept and device bring-up as people and scripts run them. Every
// test waits for the program's output, never for a time, and tolerates a machine that stalls: the
// program must then end with a fault.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using nlohmann::json;
using touchtrial::testing::ChildProcess;

namespace {

/// A folder with the test's own device settings.
class DeviceFolder {
 public:
  explicit DeviceFolder(const json& settings = json::object()) {
    replace_file(folder_.path() / "devices.json", settings.dump());
  }

  [[nodiscard]] std::vector<std::string> words(const std::string& command,
                                               const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"device", command};
    all.insert(all.end(), more.begin(), more.end());
    all.push_back("--settings");
    all.push_back((folder_.path() / "devices.json").string());
    return all;
  }
  [[nodiscard]] ProgramResult run(const std::string& command,
                                  const std::vector<std::string>& more) const {
    return run_touchtrial(folder_.path(), words(command, more));
  }
  /// Beside the test, in this folder.
  [[nodiscard]] ChildProcess start(const std::string& command,
                                   const std::vector<std::string>& more) const {
    std::vector<std::string> all = {TOUCHTRIAL_PROGRAM};
    for (const std::string& word : words(command, more)) all.push_back(word);
    return {all, {}, folder_.path().string()};
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }

 private:
  TempFolder folder_;
};

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

}  // namespace

TEST_CASE("device test goes from wall to texture in one run, and the hand stays on the plane") {
  const DeviceFolder folder;
  const ProgramResult result = folder.run("test", {"simulated", "--seconds", "2", "--json"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  const json test = json::parse(result.output);
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

TEST_CASE("device test refuses durations and rates that are no numbers") {
  for (const std::string option : {"--seconds", "--rate"}) {
    const ProgramResult result = DeviceFolder().run("test", {"simulated", option, "nan"});
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK_THAT(result.errors, holds_text(option) && holds_text("nan"));
  }
}

TEST_CASE("device test can show only the wall, and has a summary for people") {
  const ProgramResult result =
      DeviceFolder().run("test", {"simulated", "--seconds", "0.5", "--wall-only"});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.output, holds_text("wall") && holds_text("late:") && holds_text("time was up"));
  CHECK(result.output.find("texture") == std::string::npos);
}

TEST_CASE("device test --watch shows readings without a force") {
  const ProgramResult result =
      DeviceFolder().run("test", {"simulated", "--watch", "--seconds", "0.5", "--json"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  const json phases = json::parse(result.output).at("phases");
  REQUIRE(phases.size() == 1);
  CHECK(phases.at(0).at("phase") == "watch");
  CHECK(phases.at(0).at("ticks") > 0);
  CHECK(phases.at(0).at("greatest_force_n") == 0.0);
  CHECK(DeviceFolder().run("test", {"simulated", "--watch", "--wall-only"}).exit_code == 2);
}

TEST_CASE("device test ends at the letter q on a pipe, and not at the pipe's end") {
  const DeviceFolder folder;
  ChildProcess quit = folder.start("test", {"simulated", "--seconds", "3000"});
  REQUIRE(quit.says("wall  "));
  quit.write("q");
  CHECK(quit.finish() == 0);
  CHECK_THAT(quit.output(), holds_text("stopped by q"));

  ChildProcess at_end = folder.start("test", {"simulated", "--seconds", "3000"});
  at_end.close_input();
  REQUIRE(at_end.says("wall  "));
  at_end.send_signal(SIGTERM);
  CHECK(at_end.finish() == 128 + SIGTERM);
}

TEST_CASE("device test releases the force at a space, and still reports the run") {
  const DeviceFolder folder;
  ChildProcess test = folder.start("test", {"simulated", "--seconds", "3000"});
  REQUIRE(test.says("wall  "));
  test.write(" ");
  CHECK(test.finish() == 0);
  CHECK_THAT(test.output(), holds_text("let go on request"));
}

TEST_CASE("device test that a signal ends says so, and exits with the code that a shell expects") {
  const auto [signal, name] =
      GENERATE(table<int, std::string>({{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}));
  const DeviceFolder folder;
  ChildProcess test = folder.start("test", {"simulated", "--seconds", "3000"});
  REQUIRE(test.says("wall  "));
  test.send_signal(signal);
  CHECK(test.finish() == 128 + signal);
  CHECK_THAT(test.output(), holds_text("stopped by " + name) && holds_text("the force is zero"));
  CHECK_FALSE(std::filesystem::exists(folder.path("device-test-simulated-fault.csv")));
}

TEST_CASE("device test replays the recording that the settings name, to its end") {
  const DeviceFolder folder(json{{"replay", {{"trace", "stroke.csv"}}}});
  replace_file(folder.path("stroke.csv"), recorded_stroke());
  const ProgramResult result = folder.run("test", {"replay", "--seconds", "600", "--json"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  const json test = json::parse(result.output);
  CHECK(test.at("run").at("end") == "hand_stopped");
  CHECK(test.at("run").at("contact_s") > 0.0);
  REQUIRE(test.at("phases").size() == 1);
  CHECK(std::abs(test.at("phases").at(0).at("greatest_force_n").get<double>() - 0.4) < 1e-9);
}

TEST_CASE("device test refuses what it cannot open with one line and a remedy") {
  const DeviceFolder folder;
  const ProgramResult unknown = folder.run("test", {"simulatd"});
  CHECK(unknown.exit_code == 2);
  CHECK(line_count(unknown.errors) == 1);
  CHECK_THAT(unknown.errors, holds_text("did you mean simulated?"));
  const ProgramResult no_recording = folder.run("test", {"replay"});
  CHECK(no_recording.exit_code != 0);
  CHECK(line_count(no_recording.errors) == 1);
  CHECK_THAT(no_recording.errors, holds_text("replay.trace"));
}

TEST_CASE("device list and test use the library that the settings name") {
  const DeviceFolder folder(dhd_settings());
  const ProgramResult list = folder.run("list", {"--json"});
  REQUIRE(list.exit_code == 0);
  bool found = false;
  const json devices = json::parse(list.output).at("devices");
  for (const json& device : devices) {
    if (device.at("driver") != "dhd") continue;
    found = true;
    CHECK(device.at("ready") == true);
    CHECK(device.at("model") == "omega.3");
  }
  CHECK(found);

  ChildProcess test = folder.start("test", {"dhd", "--seconds", "0.5"});
  const int code = test.finish();
  INFO(test.output());
  CHECK_THAT(test.output(), holds_text("dhd: omega.3, serial 4242"));
  const bool stood_still =
      code == 1 && std::filesystem::exists(folder.path("device-test-dhd-fault.csv"));
  CHECK((code == 0 || stood_still));
}

TEST_CASE("device initialise asks before it moves anything, and says who must do it instead") {
  const ProgramResult simulated = DeviceFolder().run("initialise", {"simulated"});
  CHECK(simulated.exit_code == 2);
  CHECK_THAT(simulated.errors, holds_text("touchtrial device test simulated"));

  const DeviceFolder folder(dhd_settings());
  const ProgramResult unasked = folder.run("initialise", {"dhd"});
  CHECK(unasked.exit_code == 2);
  CHECK_THAT(unasked.errors, holds_text("the arm will move") && holds_text("--yes"));
  const ProgramResult by_hand = folder.run("initialise", {"dhd", "--yes"});
  CHECK(by_hand.exit_code == 1);
  CHECK(line_count(by_hand.errors) == 1);
  CHECK_THAT(by_hand.errors, holds_text("libdrd.so") && holds_text("rest position"));
}

TEST_CASE("device accept requires motors, every answer, and a device or a model") {
  const ProgramResult simulated = DeviceFolder().run("accept", {"simulated"});
  CHECK(simulated.exit_code == 1);
  CHECK(line_count(simulated.errors) == 1);
  CHECK_THAT(simulated.errors, holds_text("no motors"));
  const ProgramResult nothing = DeviceFolder().run("accept", {});
  CHECK(nothing.exit_code == 2);
  CHECK_THAT(nothing.errors, holds_text("--emulate"));

  const DeviceFolder folder(dhd_settings());
  const ProgramResult silent = folder.run("accept", {"dhd"});
  CHECK(silent.exit_code == 2);
  CHECK_THAT(silent.errors, holds_text("no force acts") && holds_text("answer every prompt"));
  CHECK_FALSE(std::filesystem::exists(folder.path("dhd-certificate.json")));
}

TEST_CASE("device accept ends at q and at a signal, without a certificate") {
  const DeviceFolder folder(dhd_settings());
  // With --silence it works in a process of its own.
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"dhd"}, std::vector<std::string>{"dhd", "--silence"}}) {
    ChildProcess quit = folder.start("accept", words);
    REQUIRE(quit.says("no force acts"));
    quit.write("q\n");
    CHECK(quit.finish() == 1);
    CHECK_THAT(quit.output(), holds_text("nothing was written"));
    ChildProcess ended = folder.start("accept", words);
    REQUIRE(ended.says("no force acts"));
    ended.send_signal(SIGTERM);
    CHECK(ended.finish() == 128 + SIGTERM);
  }

  ChildProcess signalled = folder.start("accept", {"dhd"});
  REQUIRE(signalled.says("no force acts"));
  signalled.send_signal(SIGINT);
  CHECK(signalled.finish() == 128 + SIGINT);
  CHECK_THAT(signalled.output(), holds_text("stopped by SIGINT"));
  CHECK_FALSE(std::filesystem::exists(folder.path("dhd-certificate.json")));
}

TEST_CASE("device accept that leaves out every step writes a certificate that fails") {
  const DeviceFolder folder(dhd_settings());
  ChildProcess skipping = folder.start("accept", {"dhd"});
  skipping.write("s\nwhat\ns\ns\n");
  const int code = skipping.finish();
  INFO(skipping.output());
  CHECK(code == 1);
  CHECK_THAT(skipping.output(), holds_text("press Enter to go on") && holds_text("Failed."));
  const json certificate = json::parse(text_of(read_file(folder.path("dhd-certificate.json"))));
  CHECK(certificate.at("passed") == false);
  CHECK(certificate.at("driver") == "dhd");
  CHECK(certificate.at("emulated") == "");
  CHECK(certificate.at("not_measured").size() >= 3);
}

TEST_CASE("device accept takes what was typed before a prompt for no answer to it") {
  const DeviceFolder folder(dhd_settings());
  std::vector<std::string> words =
      folder.words("accept", {"dhd", "--certificate", folder.path("c.json").string()});
  TerminalRun run(words);
  run.answer("[Enter, s, q] ", "s\r\r\r\r\r\r\r");
  run.answer("no force acts for 12 s", "q");
  CHECK(run.finish() == 1);
  CHECK_THAT(run.shown(), holds_text("nothing was written") && !holds_text("is pushed along axis"));
}

/// Holds Enter at the prompt of a run, and begins that run by pressing Enter anew.
/// \return false if nothing can be said, because the machine stalled: for so long that a held Enter
///   seemed to be pressed anew, or in the run, which then ended with a fault
bool only_a_fresh_enter_begins_the_run() {
  constexpr const char* kLiveLine = "us late";
  const DeviceFolder folder(dhd_settings());
  TerminalRun run(folder.words(
      "accept", {"dhd", "--skip", "rest", "--certificate", folder.path("c.json").string()}));
  run.hold_enter("[Enter, s, q] ", std::chrono::seconds(2));
  std::chrono::milliseconds pause{1500};
  if (run.shows(kLiveLine, pause)) return false;
  if (run.shown().find("let go of Enter") == std::string::npos) return false;
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

TEST_CASE("device accept takes a held Enter for one answer, and goes on at a fresh one") {
  int attempts = 1;
  while (!only_a_fresh_enter_begins_the_run()) REQUIRE(++attempts <= 10);
}

TEST_CASE("device accept loses no answer after that to a reset") {
  const json settings = {{"openhaptics", {{"library", TOUCHTRIAL_FAKE_HD}}}};
  const DeviceFolder folder(settings);
  std::vector<std::string> words = folder.words("accept", {"openhaptics"});
  words.insert(words.begin(), TOUCHTRIAL_PROGRAM);
  ChildProcess program(words, {"FAKE_HD_NEEDS_RESET=1"}, folder.path("").string());
  program.write("\nq\n");
  program.close_input();
  CHECK(program.finish() == 1);
  CHECK_THAT(program.output(), holds_text("press Enter") && holds_text("was stopped"));
}

TEST_CASE("device accept refuses files that it could not write before it opens the device") {
  const DeviceFolder folder(dhd_settings());
  const auto refusal = [&](const std::string& certificate) {
    const ProgramResult result =
        folder.run("accept", {"dhd", "--certificate", folder.path(certificate).string()});
    CHECK(result.exit_code != 0);
    CHECK(line_count(result.errors) == 1);
    return result.errors;
  };
  CHECK_THAT(refusal("c.html"), holds_text("ends in .json"));
  CHECK_THAT(refusal("no/such/c.json"), holds_text("cannot be written"));
  make_folder(folder.path("c.html"));
  CHECK_THAT(refusal("c.json"), holds_text("c.html") && holds_text("--certificate"));
  CHECK_THAT(refusal("devices.json"), holds_text("is read by this acceptance"));
  CHECK_FALSE(std::filesystem::exists(folder.path("c.json.trial")));
}

TEST_CASE("device accept never replaces the model that it rehearses on") {
  const DeviceFolder folder;
  const std::string model = R"({"name": "modelled", "mass_kg": 0.1, "max_force_n": 4})";
  replace_file(folder.path("mine-model.json"), model);
  const ProgramResult result =
      folder.run("accept", {"--emulate", folder.path("mine-model.json").string(), "--certificate",
                            folder.path("mine-certificate.json").string()});
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.errors, holds_text("mine-model.json") && holds_text("--certificate"));
  CHECK(text_of(read_file(folder.path("mine-model.json"))) == model);
  // Nor does a rehearsal on what a rehearsal wrote.
  ChildProcess first = folder.start("accept", {"--emulate", "mine-model.json", "--skip", "push"});
  CHECK(first.finish() == 1);
  const auto written = read_file(folder.path("emulated-modelled-model.json"));
  CHECK(json::parse(text_of(written)).at("name") == "emulated-modelled");
  ChildProcess second =
      folder.start("accept", {"--emulate", "emulated-modelled-model.json", "--skip", "push"});
  CHECK(second.finish() == 1);
  CHECK(read_file(folder.path("emulated-modelled-model.json")) == written);
}

TEST_CASE("device accept rehearses on a device model, and says that it proves no device") {
  const DeviceFolder folder;
  ChildProcess rehearsal = folder.start("accept", {"--emulate", "falcon"});
  const int code = rehearsal.finish();
  INFO(rehearsal.output());
  REQUIRE(code == 0);
  CHECK_THAT(rehearsal.output(),
             holds_text("REHEARSAL") && holds_text("proves the program, not a device"));
  const json certificate =
      json::parse(text_of(read_file(folder.path("emulated-falcon-certificate.json"))));
  CHECK(certificate.at("emulated") == "falcon");
  CHECK(certificate.at("passed") == true);
  const std::string page = text_of(read_file(folder.path("emulated-falcon-certificate.html")));
  CHECK_THAT(page, holds_text("REHEARSAL") && holds_text("<svg"));
  const json model = json::parse(text_of(read_file(folder.path("emulated-falcon-model.json"))));
  CHECK(model.at("mass_kg") > 0.1);
  CHECK(model.at("provenance").at("mass_kg").at("confidence") == "derived");

  // As if a device had passed: a later acceptance keeps this certificate, and one that failed is
  // not kept.
  json passed = certificate;
  passed["emulated"] = "";
  const DeviceFolder lab(dhd_settings());
  replace_file(lab.path("dhd-certificate.json"), passed.dump());
  for (int time = 0; time < 2; ++time) {
    ChildProcess skipping = lab.start("accept", {"dhd", "--force"});
    skipping.write("s\ns\ns\n");
    CHECK(skipping.finish() == 1);
    CHECK(json::parse(text_of(read_file(lab.path("dhd-certificate.json")))).at("passed") == false);
    CHECK(text_of(read_file(lab.path("dhd-certificate.json.1"))) == passed.dump());
    CHECK_FALSE(is_there(lab.path("dhd-certificate.json.2")));
  }
}

TEST_CASE("device accept refuses a broken emulated device, and takes an accelerometer's record") {
  const DeviceFolder folder;
  replace_file(folder.path("broken.json"),
               R"({"name": "broken", "mass_kg": 0.1, "coulomb_n": 0.2, "max_force_n": 4,
                   "planted": {"force_sign_scale": [1, 1, -1]}})");
  std::string record = "time_s,x_m_s2,y_m_s2,z_m_s2\n";
  for (int i = 0; i < 2000; ++i)
    record += std::to_string(0.001 * i) + ",0,0," + std::to_string(i % 2) + "\n";
  replace_file(folder.path("wall.csv"), record);
  const std::vector<std::string> words = {
      "--emulate",       folder.path("broken.json").string(),
      "--accelerometer", "wall=" + folder.path("wall.csv").string(),
      "--certificate",   folder.path("c.json").string(),
      "--json"};
  const ProgramResult result = folder.run("accept", words);
  INFO(result.errors);
  CHECK(result.exit_code == 1);
  const json certificate = json::parse(result.output);
  CHECK(certificate.at("passed") == false);
  CHECK_THAT(certificate.at("failures").dump(), holds_text("axis z") && holds_text("sign"));
  CHECK(certificate.at("spectra").at(0).at("felt") == "wall");
  CHECK(folder.run("accept", {"--emulate", "falcn"}).exit_code == 2);
}

namespace {

json bring_up_file(const DeviceFolder& folder) {
  return json::parse(text_of(read_file(folder.path("dhd-bring-up.json"))));
}

}  // namespace

TEST_CASE("device bring-up keeps what it has at q and at a signal, and says what was not done") {
  for (const bool by_signal : {false, true}) {
    const DeviceFolder folder(dhd_settings());
    ChildProcess program = folder.start("bring-up", {"omega"});
    REQUIRE(program.says("let go of it slowly"));
    program.write("s\n");
    REQUIRE(program.says("carry it straight up"));
    if (by_signal) {
      program.send_signal(SIGTERM);
    } else {
      program.write("q\n");
    }
    const int code = program.finish();
    INFO(program.output());
    CHECK(code == (by_signal ? 128 + SIGTERM : 1));
    const json file = bring_up_file(folder);
    CHECK(file.at("driver") == "dhd");
    CHECK(file.at("ended") == "stopped");
    CHECK(file.at("library") == "3.17.5.1900");
    CHECK(file.at("steps").at("rest") == "left_out");
    CHECK(file.at("steps").at("ways") == "interrupted");
    CHECK(file.at("steps").at("questions") == "not_reached");
    CHECK(file.dump().find("4242") == std::string::npos);
  }
}

TEST_CASE("device bring-up keeps what it has at the end of the input") {
  const DeviceFolder folder(dhd_settings());
  const ProgramResult result =
      folder.run("bring-up", {"dhd", "--out", folder.path("dhd-bring-up.json").string()});
  CHECK(result.exit_code == 2);
  CHECK(bring_up_file(folder).at("steps").at("rest") == "interrupted");
}

TEST_CASE("device bring-up that leaves out every step asks its questions, and its file is read") {
  const DeviceFolder folder(dhd_settings());
  ChildProcess skipping = folder.start("bring-up", {"dhd"});
  // rest, three ways, six pushes, steps, range, program, cable; then five questions.
  skipping.write("s\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\ns\n9\n1\n\n\n\n\n");
  const int code = skipping.finish();
  INFO(skipping.output());
  CHECK(code == 0);
  CHECK(bring_up_file(folder).at("ended") == "complete");
  const ProgramResult read = run_touchtrial(
      folder.path(""),
      {"device", "bring-up", "--json", "--read", folder.path("dhd-bring-up.json").string()});
  CHECK(read.exit_code == 0);
  const json verdict = json::parse(read.output);
  // The library's file is named libfake_dhd.so.
  CHECK_FALSE(verdict.at("stand_in").get<std::string>().empty());
  CHECK(verdict.at("settled") == json::array());
  CHECK(verdict.at("open").size() > 5);
  // Nothing is replaced.
  const ProgramResult again =
      folder.run("bring-up", {"dhd", "--out", folder.path("dhd-bring-up.json").string()});
  CHECK(again.exit_code == 1);
  CHECK_THAT(again.errors, holds_text("--out"));
  replace_file(folder.path("hostile.json"), R"({"kind": "touchtrial device bring-up 1"})");
  const ProgramResult hostile = run_touchtrial(
      folder.path(""), {"device", "bring-up", "--read", folder.path("hostile.json").string()});
  CHECK(hostile.exit_code == 2);
  CHECK(line_count(hostile.errors) == 1);
}

TEST_CASE("device bring-up lists the facts that nobody has verified") {
  const DeviceFolder folder;
  const ProgramResult all =
      run_touchtrial(folder.path(""), {"device", "bring-up", "--facts", "--json"});
  CHECK(all.exit_code == 0);
  CHECK(json::parse(all.output).size() == 4);
  const ProgramResult one =
      run_touchtrial(folder.path(""), {"device", "bring-up", "omega", "--facts", "--json"});
  CHECK(json::parse(one.output).size() == 1);
  CHECK(folder.run("bring-up", {"simulated"}).exit_code == 1);
  CHECK(folder.run("bring-up", {}).exit_code == 2);
}
