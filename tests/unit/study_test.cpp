// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/study/study.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {
namespace {

using namespace study;
using Json = nlohmann::json;

const std::filesystem::path source = PCBMESH_SOURCE_DIR;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream out;
  out << stream.rdbuf();
  return out.str();
}

/// A study with these further members.
std::string study_text(const std::string& members) {
  return "{\"schema_version\": 1" + (members.empty() ? "" : ",\n" + members) + "}";
}
Study parse(const std::string& members) {
  return parse_study(study_text(members), "s.json");
}

void expect_error(const std::string& text, std::initializer_list<std::string_view> words,
                  ErrorCode code = ErrorCode::study_invalid, std::int64_t line = 0) {
  try {
    (void)parse_study(text, "s.json");
    ADD_FAILURE() << "accepted: " << text.substr(0, 300);
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    for (std::string_view word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
    EXPECT_EQ(error.spot().file, "s.json") << error.what();
    EXPECT_GT(error.spot().line, 0) << error.what();
    if (line > 0) {
      EXPECT_EQ(error.spot().line, line) << error.what();
    }
    EXPECT_LT(std::string(error.what()).size(), 600U);
  }
}
void expect_field_error(const std::string& members, std::initializer_list<std::string_view> words) {
  expect_error(study_text(members), words);
}

TEST(Study, AnEmptyStudyHasEveryDefault) {
  EXPECT_EQ(parse(""), Study{});
}

TEST(Study, EveryFieldIsRead) {
  const Study s = parse(R"("note": "n", "$schema": "x",
    "region": {"kind": "nets", "nets": ["A", "/B,c"], "margin": "1.5mm", "box": {"min": [0, "-1mm"], "max": ["20um", 3]}},
    "conductors": {"mode": "hollow", "rules": [{"net": "A", "mode": "solid"}, {"layer": "F.Cu", "mode": "hollow"}, {"mode": "solid"}]},
    "air": {"above": 3, "below": "0mm", "around": "12mil"},
    "mesh": {"frequency": "10GHz", "longest_edge": 0.5, "min_angle_deg": 25, "edge_at_copper": "50um", "growth": 0.4,
             "seed": "delaunay", "smooth": true,
             "height_policy": "matched", "sublayers": "floor", "elements_per_wavelength": 12.5, "elements_per_dielectric": 3,
             "skin_depth_layers": 2, "height_growth": 1.8, "target_quality": 0.8, "budget_prisms": 1e6,
             "budget_unknowns": 3e6, "paper_compat": false, "tolerance": "7um"},
    "arcs": {"sagitta": "1um", "mode": "octagon"}, "output": {"unit": "mm"}, "limits": {"max_prisms": 2e6})");
  EXPECT_EQ(s.region, RegionKind::nets);
  EXPECT_EQ(s.nets, (std::vector<std::string>{"A", "/B,c"}));
  EXPECT_EQ(s.margin, 1'500'000);
  ASSERT_TRUE(s.box);
  EXPECT_EQ(s.box->min, (geometry::Point{0, -1'000'000}));
  EXPECT_EQ(s.box->max, (geometry::Point{20'000, 3'000'000}));
  EXPECT_EQ(s.conductors, ConductorMode::hollow);
  ASSERT_EQ(s.conductor_rules.size(), 3U);
  EXPECT_EQ(s.conductor_rules[1], (ConductorRule{"", "F.Cu", ConductorMode::hollow}));
  EXPECT_EQ(s.air_above, 3'000'000);
  EXPECT_EQ(s.air_below, 0);
  EXPECT_EQ(s.air_around, 304'800);
  EXPECT_EQ(s.frequency_hz, 1e10);
  EXPECT_EQ(s.longest_edge, 500'000);
  EXPECT_EQ(s.min_angle_deg, 25);
  EXPECT_EQ(s.edge_at_copper, 50'000);
  EXPECT_EQ(s.growth, 0.4);
  EXPECT_TRUE(s.smooth);
  EXPECT_EQ(s.policy, HeightPolicy::matched);
  EXPECT_EQ(s.height_bounds, (HeightBounds{12.5, 3, 2, 1.8}));
  EXPECT_EQ(s.match, (MatchGoal{0.8, 1'000'000, 3'000'000}));
  EXPECT_EQ(s.sublayers, SublayerRule::floor);
  EXPECT_EQ(s.tolerance, 7'000);
  EXPECT_EQ(s.arcs.sagitta_nm, 1'000);
  EXPECT_EQ(s.arcs.mode, geometry::ArcMode::octagon);
  EXPECT_EQ(s.unit, LengthUnit::millimetre);
  EXPECT_EQ(s.max_prisms, 2'000'000);
  EXPECT_EQ(parse_study(to_json(s), "again"), s);
}

TEST(Study, RegionKindFollowsFromWhatIsGiven) {
  EXPECT_EQ(parse(R"("region": {"nets": ["A"]})").region, RegionKind::nets);
  EXPECT_EQ(parse(R"("region": {"box": {"min": [0, 0], "max": [1, 1]}})").region, RegionKind::box);
  EXPECT_EQ(parse(R"("region": {"kind": "whole", "nets": ["A"]})").region, RegionKind::whole)
      << "nets of interest on the whole board";
  EXPECT_EQ(parse(R"("region": {"box": null})").region, RegionKind::whole);
  EXPECT_EQ(parse(R"("region": {"nets": ["A"], "box": {"min": [0, 0], "max": [1, 1]}})").region, RegionKind::box)
      << "a box bounds the domain; nets beside it are the nets of interest";
}

TEST(Study, BoundsOnHeightsAndGoalsAreChecked) {
  EXPECT_TRUE(parse(R"("mesh": {"paper_compat": true, "height_policy": 4})").paper_compat);
  expect_field_error(R"("mesh": {"elements_per_wavelength": 0.5})", {"/mesh/elements_per_wavelength", "1 to 1000"});
  expect_field_error(R"("mesh": {"elements_per_dielectric": 0})", {"/mesh/elements_per_dielectric"});
  expect_field_error(R"("mesh": {"elements_per_dielectric": 1e12})", {"/mesh/elements_per_dielectric"});
  expect_field_error(R"("mesh": {"elements_per_dielectric": 2.5})", {"/mesh/elements_per_dielectric", "whole"});
  expect_field_error(R"("mesh": {"skin_depth_layers": 2})", {"/mesh/skin_depth_layers", "frequency"});
  expect_field_error(R"("mesh": {"height_growth": 1})", {"/mesh/height_growth", "1.1"});
  expect_field_error(R"("mesh": {"height_policy": 7, "target_quality": 1.5})", {"/mesh/target_quality"});
  expect_field_error(R"("mesh": {"height_policy": 7, "budget_prisms": 0})", {"/mesh/budget_prisms"});
  expect_field_error(R"("mesh": {"target_quality": 0.8})", {"/mesh/height_policy", "matched", "average"});
  expect_field_error(R"("mesh": {"paper_compat": true, "seed": "hex"})", {"/mesh/paper_compat"});
  expect_field_error(R"("mesh": {"paper_compat": true, "height_policy": "weighted"})", {"/mesh/paper_compat"});
  expect_field_error(R"("mesh": {"paper_compat": true, "height_growth": 2})", {"/mesh/paper_compat"});
}

TEST(Study, PolicyNumbersArePolicies) {
  const HeightPolicy cases[] = {HeightPolicy::basic,   HeightPolicy::average,        HeightPolicy::maximum,
                                HeightPolicy::minimum, HeightPolicy::thinnest_layer, HeightPolicy::weighted,
                                HeightPolicy::matched};
  for (int i = 1; i <= 7; ++i) {
    EXPECT_EQ(parse_height_policy(std::to_string(i)), cases[i - 1]);
    EXPECT_EQ(parse(fmt::format(R"("mesh": {{"height_policy": {}}})", i)).policy, cases[i - 1]);
    EXPECT_EQ(parse(fmt::format(R"("mesh": {{"height_policy": "{}"}})", i)).policy, cases[i - 1]);
  }
  for (const char* wrong : {"0", "8", "", "Basic", "1.0"}) EXPECT_THROW((void)parse_height_policy(wrong), Error) << wrong;
  expect_field_error(R"("mesh": {"height_policy": 8})", {"/mesh/height_policy", "basic, average"});
}

TEST(Study, NamesAndParsersAreInverse) {
  for (HeightPolicy v : {HeightPolicy::none, HeightPolicy::basic, HeightPolicy::average, HeightPolicy::maximum,
                         HeightPolicy::minimum, HeightPolicy::thinnest_layer, HeightPolicy::weighted, HeightPolicy::matched})
    EXPECT_EQ(parse_height_policy(name_of(v)), v);
  for (SublayerRule v :
       {SublayerRule::floor, SublayerRule::round, SublayerRule::ceil, SublayerRule::none, SublayerRule::optimal})
    EXPECT_EQ(parse_sublayer_rule(name_of(v)), v);
  for (ConductorMode v : {ConductorMode::solid, ConductorMode::hollow, ConductorMode::sheet})
    EXPECT_EQ(parse_conductor_mode(name_of(v)), v);
  EXPECT_EQ(name_of(RegionKind::box), "box");
  try {
    (void)parse_conductor_mode("holow");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(error.text().find("solid, hollow, sheet; did you mean 'hollow'?"), std::string::npos) << error.text();
  }
}

TEST(Study, RoundTripIsExactForRandomStudies) {
  std::mt19937_64 random(7);
  const auto upto = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most + 1));
  };
  const auto real = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int round = 0; round < 500; ++round) {
    Study s;
    s.region = static_cast<RegionKind>(upto(2));
    for (std::int64_t i = 0; i <= upto(3); ++i) s.nets.push_back(fmt::format("net \"{}\\\n\xC3\xA9{}", i, random()));
    s.margin = upto(max_coordinate_nm);
    if (s.region == RegionKind::box || upto(1) == 1) {
      const Nm x = upto(1'000'000'000) - 500'000'000, y = -upto(1'000'000'000);
      s.box = geometry::Box{{x, y}, {x + 1 + upto(400'000'000), y + 1 + upto(1'000'000'000)}};
    }
    s.conductors = static_cast<ConductorMode>(upto(1));
    for (std::int64_t i = 0; i < upto(3); ++i)
      s.conductor_rules.push_back({upto(1) == 1 ? "N" : "", upto(1) == 1 ? "L" : "", static_cast<ConductorMode>(upto(1))});
    s.air_above = upto(max_coordinate_nm);
    s.air_below = upto(1000) * 1000;
    s.air_around = upto(1000) * 1'000'000;
    if (upto(1) == 1) s.frequency_hz = real(1, 1e12);
    if (upto(1) == 1) s.longest_edge = 500'000'000 + upto(500'000'000);
    if (upto(1) == 1) s.edge_at_copper = 1 + upto(499'999'999);
    if (upto(1) == 1) s.tolerance = 1 + upto(999'999);
    s.min_angle_deg = real(0.1, 28.6);
    s.growth = real(0.01, 10);
    if (!s.edge_at_copper) s.seed = static_cast<TriangleSeed>(upto(1));
    s.smooth = upto(1) == 1;
    s.policy = static_cast<HeightPolicy>(upto(7));
    s.height_bounds.elements_per_wavelength = real(1, 1000);
    if (upto(1) == 1) s.height_bounds.elements_per_dielectric = static_cast<int>(1 + upto(999));
    if (s.frequency_hz && upto(1) == 1) s.height_bounds.skin_depth_layers = static_cast<int>(1 + upto(19));
    if (upto(1) == 1) s.height_bounds.height_growth = real(1.1, 100);
    if (s.policy == HeightPolicy::matched) {
      if (upto(1) == 1) s.match.target_quality = real(0.01, 1.02);
      if (upto(1) == 1) s.match.budget_prisms = 1 + upto(std::int64_t{1} << 60);
      if (upto(1) == 1) s.match.budget_unknowns = 1 + upto(std::int64_t{1} << 60);
    }
    s.sublayers = static_cast<SublayerRule>(upto(5));
    s.arcs = {1 + upto(999'999), static_cast<geometry::ArcMode>(upto(3))};
    s.unit = static_cast<LengthUnit>(upto(2));
    s.max_prisms = 1 + upto(std::int64_t{1} << 61);
    ASSERT_NO_THROW(check(s));
    const std::string text = to_json(s);
    const Study again = parse_study(text, "round trip");
    ASSERT_EQ(again, s) << text;
    ASSERT_EQ(to_json(again), text);
  }
}

TEST(Study, EqualityLooksAtEveryField) {
  const Study base;
  std::vector<Study> others(30);
  std::size_t i = 0;
  others[i++].region = RegionKind::box;
  others[i++].nets = {"A"};
  others[i++].margin = 1;
  others[i++].box = geometry::Box{{0, 0}, {1, 1}};
  others[i++].conductors = ConductorMode::hollow;
  others[i++].conductor_rules.resize(1);
  others[i++].air_above = 1;
  others[i++].air_below = 1;
  others[i++].air_around = 1;
  others[i++].frequency_hz = 1;
  others[i++].longest_edge = 1;
  others[i++].min_angle_deg = 1;
  others[i++].edge_at_copper = 1;
  others[i++].growth = 1;
  others[i++].seed = TriangleSeed::hex;
  others[i++].smooth = true;
  others[i++].policy = HeightPolicy::none;
  others[i++].sublayers = SublayerRule::none;
  others[i++].height_bounds.elements_per_wavelength = 4;
  others[i++].height_bounds.elements_per_dielectric = 1;
  others[i++].height_bounds.skin_depth_layers = 1;
  others[i++].height_bounds.height_growth = 2;
  others[i++].match.target_quality = 0.5;
  others[i++].match.budget_prisms = 1;
  others[i++].match.budget_unknowns = 1;
  others[i++].paper_compat = true;
  others[i++].tolerance = 1;
  others[i++].arcs.sagitta_nm = 1;
  others[i++].arcs.mode = geometry::ArcMode::octagon;
  others[i++].unit = LengthUnit::micrometre;
  ASSERT_EQ(i, others.size());
  for (const Study& other : others) EXPECT_FALSE(other == base) << to_json(other);
  Study other;
  other.max_prisms = 1;
  EXPECT_FALSE(other == base);
}

TEST(Study, HexagonalSeedHasOneEdgeLength) {
  EXPECT_EQ(parse(R"("mesh": {"seed": "hex"})").seed, TriangleSeed::hex);
  expect_field_error(R"("mesh": {"seed": "hex", "edge_at_copper": "50um"})", {"/mesh/seed", "edge_at_copper"});
}

TEST(Study, UnknownFieldsAreErrorsWithTheNearestName) {
  expect_error("{\n\"schema_version\": 1,\n\"aire\": {}}", {"/aire", "did you mean 'air'?"}, ErrorCode::study_invalid, 3);
  expect_field_error(R"("air": {"abvoe": 1})", {"/air/abvoe", "did you mean 'above'?"});
  expect_field_error(R"("region": {"net": ["A"]})", {"/region/net", "'nets'"});
  expect_field_error(R"("mesh": {"frequenzy": 1})", {"/mesh/frequenzy", "'frequency'"});
  expect_field_error(R"("mesh": {"xyzzy": 1})", {"/mesh/xyzzy", "fields here are frequency, longest_edge"});
  expect_field_error(R"("conductors": {"rules": [{"mode": "solid"}, {"mode": "solid", "nett": "A"}]})",
                     {"/conductors/rules/1/nett", "'net'"});
  expect_field_error(R"("arcs": {"a/b~c": 1})", {"/arcs/a~1b~0c"});
}

TEST(Study, WrongTypesAreErrors) {
  expect_field_error(R"("air": [])", {"/air", "expected an object, found an array"});
  expect_field_error(R"("air": {"above": true})", {"/air/above", "a length", "found true or false"});
  expect_field_error(R"("air": {"above": null})", {"/air/above", "found null"});
  expect_field_error(R"("air": {"above": "1"})", {"/air/above", "has no unit"});
  expect_field_error(R"("air": {"above": ""})", {"/air/above"});
  expect_field_error(R"("air": {"above": "1 parsec"})", {"/air/above", "parsec"});
  expect_field_error(R"("region": {"nets": "A"})", {"/region/nets", "an array"});
  expect_field_error(R"("region": {"nets": [1]})", {"/region/nets/0", "a string"});
  expect_field_error(R"("region": {"box": {"min": [0, 0]}})", {"/region/box", "'max' is missing"});
  expect_field_error(R"("region": {"box": {"min": [0], "max": [1, 1]}})", {"/region/box/min", "[x, y]"});
  expect_field_error(R"("conductors": {"rules": [{"net": "A"}]})", {"/conductors/rules/0", "'mode' is missing"});
  expect_field_error(R"("conductors": {"mode": "solids"})", {"/conductors/mode", "did you mean 'solid'?"});
  expect_field_error(R"("mesh": {"frequency": "10Ghz"})", {"/mesh/frequency", "unknown unit"});
  expect_field_error(R"("output": {"unit": "inch"})", {"/output/unit", "m, mm or um"});
  expect_field_error(R"("limits": {"max_prisms": 1.5})", {"/limits/max_prisms", "whole number"});
  expect_field_error(R"("limits": {"max_prisms": 1e30})", {"/limits/max_prisms"});
  expect_error("{\"schema_version\": 2}", {"/schema_version", "version 2"});
  expect_error("{\"schema_version\": \"1\"}", {"/schema_version"});
  expect_error("{}", {"'schema_version' is missing"});
  expect_error("[]", {"expected an object"});
  expect_error("3", {"expected an object"});
}

TEST(Study, ValuesOutOfRangeAreErrorsWithTheirLine) {
  expect_error("{\"schema_version\": 1,\n\"air\": {\n\"above\": -1}}", {"/air/above", "-1 mm"}, ErrorCode::study_invalid, 3);
  expect_error("{\"schema_version\": 1,\n\"air\": {\n\"above\": -1\n}\n}", {"/air/above"}, ErrorCode::study_invalid, 3);
  expect_field_error(R"("air": {"above": 1e300})", {"/air/above"});
  expect_field_error(R"("air": {"above": 1001})", {"/air/above"});
  expect_field_error(R"("region": {"kind": "nets"})", {"/region/nets", "at least one"});
  expect_field_error(R"("region": {"nets": [""]})", {"/region/nets", "empty"});
  expect_field_error(R"("region": {"nets": ["A", "B", "A"]})", {"/region/nets", "'A'", "twice"});
  expect_field_error(R"("region": {"kind": "box"})", {"/region/box"});
  expect_field_error(R"("region": {"box": {"min": [1, 1], "max": [1, 2]}})", {"/region/box", "empty"});
  expect_field_error(R"("region": {"margin": "-1um"})", {"/region/margin"});
  for (const char* angle : {"0", "-1", "28.7", "90", "1e300"})
    expect_field_error(fmt::format(R"("mesh": {{"min_angle_deg": {}}})", angle), {"/mesh/min_angle_deg", "28.6"});
  for (const char* growth : {"0", "-0.1", "11"})
    expect_field_error(fmt::format(R"("mesh": {{"growth": {}}})", growth), {"/mesh/growth"});
  for (const char* edge : {"0", "-1", "\"0um\""})
    expect_field_error(fmt::format(R"("mesh": {{"longest_edge": {}}})", edge), {"/mesh/longest_edge"});
  expect_field_error(R"("mesh": {"longest_edge": 1, "edge_at_copper": 2})",
                     {"/mesh/edge_at_copper", "longer than the longest edge"});
  for (const char* f : {"0", "-5", "1e300", "\"0Hz\""})
    expect_field_error(fmt::format(R"("mesh": {{"frequency": {}}})", f), {"/mesh/frequency"});
  expect_field_error(R"("mesh": {"tolerance": 2})", {"/mesh/tolerance"});
  expect_field_error(R"("arcs": {"sagitta": 0})", {"/arcs/sagitta"});
  expect_field_error(R"("limits": {"max_prisms": 0})", {"/limits/max_prisms"});
  expect_field_error(R"("limits": {"max_prisms": -9223372036854775808})", {"/limits/max_prisms"});
}

TEST(Study, CheckRefusesWhatJsonCannotHold) {
  Study s;
  s.growth = std::nan("");
  EXPECT_THROW(check(s), Error);
  s = {};
  s.min_angle_deg = INFINITY;
  EXPECT_THROW(check(s), Error);
  s = {};
  s.frequency_hz = std::nan("");
  EXPECT_THROW(check(s), Error);
  EXPECT_NO_THROW(check(Study{}));
}

TEST(Study, SyntaxErrorsCarryTheLine) {
  expect_error("{\n\"schema_version\": 1,\n\"air\": {,}\n}", {"JSON syntax error"}, ErrorCode::file_syntax, 3);
  expect_error("{\"schema_version\": 1,\n\"air\": {\"above\": NaN}}", {"JSON syntax error"}, ErrorCode::file_syntax, 2);
  expect_error("{\"schema_version\": 1,\n\"mesh\": {\"growth\": 1e999}}", {"1e999"}, ErrorCode::input_number, 2);
  expect_error("{\"schema_version\": 1,\n\"air\": {}, \"air\": {}}", {"'air'", "twice"}, ErrorCode::file_syntax, 2);
  expect_error(std::string(1000, '['), {"nested deeper"}, ErrorCode::file_syntax);
  expect_error("", {"JSON syntax error"}, ErrorCode::file_syntax);
  try {
    (void)read_study("/nonexistent/s.json");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_unreadable);
  }
}

TEST(Study, TextThatIsNoUtf8IsStillWritten) {
  Study s;
  s.nets = {"a\xFF"};
  EXPECT_NO_THROW((void)parse_study(to_json(s), "s"));
}

/// Defaults of an object schema, nested.
Json defaults_of(const Json& schema) {
  Json out = Json::object();
  for (const auto& [name, field] : schema.at("properties").items()) {
    if (name == "$schema") continue;
    if (field.contains("properties"))
      out[name] = defaults_of(field);
    else if (field.contains("const"))
      out[name] = field.at("const");
    else
      out[name] = field.at("default");
  }
  return out;
}

void expect_same_fields(const Json& schema, const Json& written, const std::string& place) {
  std::set<std::string> published, found;
  for (const auto& [name, field] : schema.at("properties").items())
    if (name != "$schema" && name != "note" && name != "all") published.insert(name);
  for (const auto& [name, value] : written.items()) found.insert(name);
  EXPECT_EQ(published, found) << place;
  for (const auto& [name, value] : written.items())
    if (value.is_object() && schema.at("properties").contains(name) && schema.at("properties").at(name).contains("properties"))
      expect_same_fields(schema.at("properties").at(name), value, place + "/" + name);
}

TEST(Study, PublishedSchemaHasTheSameFieldsAndDefaults) {
  const Json schema = Json::parse(text_of(source / "docs/schema/study.schema.json"));
  EXPECT_EQ(parse_study(defaults_of(schema).dump(), "schema"), Study{});
  expect_same_fields(schema, Json::parse(to_json(Study{})), "");
}

TEST(Study, ExamplesAreRead) {
  const Study microstrip = read_study(source / "examples/microstrip.study.json");
  EXPECT_EQ(microstrip.frequency_hz, 1e10);
  EXPECT_EQ(microstrip.conductor_rules.size(), 1U);
  const Study paper = read_study(source / "examples/paper.study.json");
  EXPECT_EQ(paper.air_above + paper.air_below + paper.air_around, 0);
  EXPECT_EQ(paper.longest_edge, 2'000'000);
}

TEST(Study, SplitsWhereTheSolverHasNoEdgeElementsOnPrisms) {
  const std::string waves = R"("solver": "dolfinx", "problem": "eigenmode")";
  EXPECT_EQ(parse(waves).split, ElementSplit::tetrahedra) << "nothing is said";
  EXPECT_EQ(parse(R"("solver": "dolfinx", "problem": "electrostatic")").split, ElementSplit::none);
  EXPECT_EQ(parse(R"("solver": "getdp", "problem": "eigenmode")").split, ElementSplit::none);
  try {
    (void)parse(waves + R"(, "output": {"split": "none"})");
    ADD_FAILURE() << "prisms are refused";
  } catch (const Error& error) {
    EXPECT_NE(error.text().find("--split tets"), std::string::npos) << error.text();
  }
  EXPECT_THROW((void)parse(R"("solver": "getdp", "problem": "eigenmode", "output": {"order": 2})"), Error);
  EXPECT_NO_THROW((void)parse(R"("solver": "palace", "problem": "eigenmode", "output": {"order": 2})"));
}

}  // namespace
}  // namespace pcbmesh
