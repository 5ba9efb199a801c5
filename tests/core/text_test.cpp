#include "core/text.hpp"

#include "support/catch.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;

TEST_CASE("words for missing and truth values are recognised in any capitals, but ids are not") {
  for (const char* word :
       {"NA", "na", "N/A", "NaN", "nan", "NULL", "null", "None", "TRUE", "False"}) {
    CHECK(is_read_as_missing(word));
  }
  for (const char* word : {"", "P01", "001", "NA1", "nano", "T", "0"}) {
    CHECK_FALSE(is_read_as_missing(word));
  }
}

TEST_CASE("formulas of spreadsheets are recognised by their first character") {
  for (const char* text : {"=1", "+1", "-a", "@a", "\ta", "\ra"}) CHECK(begins_like_formula(text));
  for (const char* text : {"", "a=1", "1-2", "_a", "'=1"}) CHECK_FALSE(begins_like_formula(text));
}

TEST_CASE("names that look alike have one skeleton, others do not") {
  const std::string no_el = "No\xc3\xabl";    // one letter with a diaeresis
  const std::string no_e_l = "Noe\xcc\x88l";  // a letter and a diaeresis
  CHECK(skeleton_of(no_el) == skeleton_of(no_e_l));
  CHECK(skeleton_of("Fine Cloth") == skeleton_of("fine-cloth"));
  CHECK(skeleton_of("a\xe2\x80\x8b") == skeleton_of("A"));  // a blank of no width
  CHECK(skeleton_of("\xef\xbc\xa4"
                    "9") == skeleton_of("d9"));                // a wide D
  CHECK(skeleton_of("a\xe2\x80\x93z") == skeleton_of("a z"));  // an en dash
  const std::vector<std::pair<std::string, std::string>> alphabets = {
      {"oak", "\xd0\xbe\xd0\xb0\xd0\xba"},  // Cyrillic letters
      {"COMET", "\xd0\xa1\xd0\x9e\xd0\x9c\xd0\x95\xd0\xa2"},
      {"e\xcc\x88", "\xd1\x91"},
      {"t\xc3\xa1p", "\xcf\x84\xce\xac\xcf\x81"},  // Greek ones
      {"ZINA", "\xce\x96\xce\x99\xce\x9d\xce\x91"}};
  for (const auto& [latin, other] : alphabets) {
    CAPTURE(latin);
    CHECK(skeleton_of(latin) == skeleton_of(other));
  }
  CHECK(skeleton_of("50 \xc2\xb5m") != skeleton_of("50 mm"));
  CHECK(skeleton_of("\xd1\x81\xd0\xbe\xd1\x81\xd0\xbd\xd0\xb0") != skeleton_of("cocoa"));
  CHECK(skeleton_of("bark") != skeleton_of("bark2"));
  CHECK(skeleton_of("Noel") != skeleton_of(no_el));
  CHECK(skeleton_of("latin\xe9") == "latin\xe9");
  CHECK(skeleton_of("").empty());
}
