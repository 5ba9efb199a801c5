#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/drivers/replay/replay_device.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <string>

namespace touchtrial {
namespace {

/// A file that is removed when the test ends.
class CsvFile {
 public:
  explicit CsvFile(std::string_view content) { replace_file(path(), content); }
  [[nodiscard]] device::RecordedMotion read() const { return device::read_motion_csv(path()); }

 private:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "motion.csv"; }

  TempFolder folder_;
};

constexpr const char* kHeader = "time_s,x_mm,y_mm,z_mm\n";

TEST_CASE("a motion's rate and positions are read from its rows") {
  const device::RecordedMotion motion =
      CsvFile(std::string(kHeader) + "0.5,1,2,3\n0.5005,4,5,6\n0.501,7e0,-8,9.25\n").read();
  CHECK(motion.rate_hz() == 2000.0);
  REQUIRE(motion.ticks() == 3);
  CHECK(motion.position_mm(0) == Vec3{1, 2, 3});
  CHECK(motion.position_mm(2) == Vec3{7, -8, 9.25});
}

TEST_CASE("columns are found by name, also in quotation marks, with either line end") {
  const device::RecordedMotion motion = CsvFile(
                                            "\xEF\xBB\xBFz_mm,\"force\",time_s,\"x_mm\",y_mm\r\n"
                                            "3,\"a b\",0,1,2\r\n6,,\"0.001\",4,5")
                                            .read();
  CHECK(motion.rate_hz() == 1000.0);
  REQUIRE(motion.ticks() == 2);
  CHECK(motion.position_mm(0) == Vec3{1, 2, 3});
  CHECK(motion.position_mm(1) == Vec3{4, 5, 6});
}

TEST_CASE("where rows are missing the hand continues in a straight line") {
  const device::RecordedMotion motion =
      CsvFile(std::string(kHeader) + "0,0,0,0\n0.001,1,0,0\n0.002,2,0,0\n0.006,6,8,0\n").read();
  CHECK(motion.rate_hz() == 1000.0);
  REQUIRE(motion.ticks() == 7);
  CHECK(motion.position_mm(4) == Vec3{4, 4, 0});
  CHECK(motion.position_mm(6) == Vec3{6, 8, 0});
}

TEST_CASE("rounded times do not add up to a wrong rate") {
  std::string text = kHeader;
  for (std::int64_t i = 0; i <= 3000; ++i) {
    const std::string micros = std::to_string(1'000'000 + (i * 1'000'000 + 1500) / 3000);
    text += micros.substr(0, 1) + '.' + micros.substr(1) + ",0,0,0\n";
  }
  const device::RecordedMotion motion = CsvFile(text).read();
  CHECK(motion.ticks() == 3001);
  CHECK(motion.rate_hz() == 3000.0);
}

TEST_CASE("a hostile motion file is refused in one line that names the place") {
  const auto [content, places] = GENERATE(table<std::string, std::string>(
      {{"", "motion.csv"},
       {"time_s,x_mm,y_mm\n0,1,2\n", "1 z_mm"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n", "motion.csv"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,0,0\n", "3 4"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,0,0,0x\n", "3 z_mm 0x"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,nan,0,0\n", "x_mm"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,inf,0,0\n", "x_mm"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,1e999,0,0\n", "x_mm"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.001,20000,0,0\n", "x_mm 10"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,0,0\n", "3 time_s"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n5,0,0,0\n", "10 20,000"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n1e-9,0,0,0\n", "10 20,000"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n1e-3,0,0,0\n2e-3,0,0,0\n1e18,0,0,0\n", "motion.csv"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,0\n1e-3,0,0,0\n2e-3,0,0,0\n2.1e-3,0,0,0\n", "motion.csv"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,0,\"0\n", "2 z_mm"},
       {"time_s,x_mm,y_mm,z_mm\n0,0,\"0,0\",0\n", "2 5 4"},
       {std::string("\0\0\0\0", 4), "time_s"}}));
  const CsvFile file(content);
  CHECK_THROWS_AS(file.read(), FileError);
  CHECK_THROWS_WITH(file.read(), names("motion.csv") && names(places) && !holds_text("\n"));
}

TEST_CASE("a missing motion file is refused") {
  CHECK_THROWS_AS(device::read_motion_csv("/nowhere/motion.csv"), FileError);
}

}  // namespace
}  // namespace touchtrial
