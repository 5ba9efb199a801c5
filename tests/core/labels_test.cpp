#include "core/labels.hpp"

#include "support/catch.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;

namespace {

const std::string kCyrillic = "\xd1\x81\xd0\xbe\xd1\x80\xd0\xba";  // looks like copk

}  // namespace

TEST_CASE("a label may have letters of any alphabet, but a word of Latin ones no others") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"cork", ""},
      {std::string(64, 'x'), ""},
      {"\xc3\xa9"
       "corce d'arbre",
       ""},
      {"Noe\xcc\x88l", ""},
      {kCyrillic, ""},
      {"cork " + kCyrillic, ""},
      {"\xce\xb2-keratin", ""},
      {"50 \xc2\xb5m", ""},
      {"STRA\xe1\xba\x9e"
       "E",
       ""},
      {"T\xe6\x81\xa4", ""},
      {"c\xd0\xberk", "mixes Latin letters with those of another alphabet in one word"},
      {"\xce\x91lpaca", "mixes Latin letters with those of another alphabet in one word"},
      {"", "is empty"},
      {"latin\xe9", "is not UTF-8"},
      {std::string(65, 'x'), "has 65 bytes, must have at most 64"},
      {"a\nb", "has a control character"},
      {"a\xc2\x85z", "has a control character"},
      {"a ", "begins or ends with a blank"},
      {"nan", "is what other programs take for a missing or truth value"},
      {"=1", "begins like a formula"}};
  for (const auto& [label, fault] : cases) {
    CAPTURE(label);
    CHECK(fault_of_label(label) == fault);
  }
  CHECK((alphabets_of("cork").latin && !alphabets_of("cork 9").other));
  CHECK((!alphabets_of(kCyrillic).latin && alphabets_of(kCyrillic).other));
}

TEST_CASE("labels of several alphabets are to be looked at, those of one are not") {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"cork", "silk"}, ""},
      {{kCyrillic, "9"}, ""},
      {{"cork", "silk", kCyrillic},
       "labels have Latin letters (\"cork\" and 1 more) and others (\"" + kCyrillic +
           "\"); look whether any two look alike, and rename one"}};
  for (const auto& [labels, remark] : cases) CHECK(remark_on_alphabets(labels) == remark);
}
