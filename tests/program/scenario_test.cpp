// SPDX-License-Identifier: BSD-3-Clause
// The sample scenes from end to end, checked by the data that their runs write.
#include "program.h"

#include <nlohmann/json.hpp>

namespace vps {
namespace {

using nlohmann::json;

const std::string kScenes = VPS_SOURCE_DIR "/scenes/";

class Scenario : public Program {
 protected:
  json read(const std::string& name) const { return json::parse(slurp(folder_ / name)); }

  /// Writes the peg-in-hole scene with other lines for its step, and with absolute paths of its meshes.
  void writePegScene(const std::string& peg, const std::string& step) const {
    const std::string folder = kScenes + "peg_in_hole/";
    write("scene.toml", "unit = 'mm'\n[[part]]\nfile = '" + folder +
                            "hole.stl'\nfixed = true\n[[part]]\nfile = '" + folder + "peg.stl'\n" + peg +
                            "[[step]]\npart = 'peg'\n" + step);
  }
};

json withoutWall(json data) {
  data.erase("wall");
  return data;
}

TEST_F(Scenario, TheBookOfTheBearingBlockFollowsThePlan) {
  const Ran ran = run("plan " + kScenes + "bearing_block/scene.toml -o planned --book book.html");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const std::string page = slurp(folder_ / "book.html");
  const json plan = read("planned/plan.json");
  std::size_t last = 0, number = 0;
  for (const json& step : plan["assemblies"][0]["steps"]) {
    const std::size_t at = page.find("<h2>Step " + std::to_string(++number) +
                                     " of 9: " + step["name"].get<std::string>() + "</h2>");
    ASSERT_NE(at, std::string::npos) << step["name"];
    EXPECT_GT(at, last);
    last = at;
  }
  EXPECT_EQ(number, 9U);
  // Each part is in one row of the parts list; equal parts share a row.
  const std::size_t from = page.find("<table class=\"items\">");
  ASSERT_NE(from, std::string::npos);
  const std::string items = page.substr(from, page.find("</table>", from) - from);
  for (const char* row : {">housing<", ">bushing_lower<", ">shaft<", ">bushing_upper<", ">key<", ">cover<",
                          ">dowel_2, dowel_1<", ">screw_2, screw_1<"}) {
    const std::size_t at = items.find(row);
    ASSERT_NE(at, std::string::npos) << row << "\n" << items;
    EXPECT_EQ(items.find(row, at + 1), std::string::npos) << row;
  }
  for (const char* words : {"clears &#39;bushing_upper&#39; by only 500 µm",
                            "Fit (shaft H8/h7) of "
                            "&#39;shaft&#39; in &#39;bushing_lower&#39;: 12.000 mm in 12.024 mm",
                            "Play of &#39;key&#39; in the finished assembly"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

// Requirements for the bearing block: every part reaches its target, penetrates another by at most a quarter
// of the fit's clearance or 10 um, and drifts by at most 5 um in the 2 s after release, with gravity and
// without sleeping.
TEST_F(Scenario, BearingBlockGoesTogetherByContact) {
  const Ran ran = run("assemble " + kScenes + "bearing_block/scene.toml --out out");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const json data = read("out/assemble.json");
  EXPECT_TRUE(data["completed"].get<bool>());
  ASSERT_EQ(data["steps"].size(), 9u);
  for (const json& step : data["steps"]) {
    const std::string part = step["part"];
    EXPECT_TRUE(step["completed"].get<bool>()) << part;
    EXPECT_LE(step["max_penetration_m"].get<double>(), step["penetration_limit_m"].get<double>()) << part;
    EXPECT_LE(step["penetration_limit_m"].get<double>(), 10e-6) << part;
    EXPECT_LE(step["rest_drift_m"].get<double>(), 5e-6) << part;
    EXPECT_GE(step["rest_s"].get<double>(), 2 - 1e-9) << part;
    // The step was made by contact: the part touched others on its way, and the hand felt a force at the end.
    EXPECT_GE(step["impacts"].get<int>() + step["slides"].get<int>(), 1) << part;
    EXPECT_GT(step["peak_force_N"].get<double>(), 1) << part;
    EXPECT_LE(step["peak_force_N"].get<double>(), 30) << part;  // the device's peak, from its paper
  }
  EXPECT_EQ(data["contacts_left_out"].get<long>(), 0);
  EXPECT_EQ(data["physics"]["ticks"].get<long>(), data["haptic"]["ticks"].get<long>());
  for (const char* file : {"report.html", "trace.csv", "steps.csv"})
    EXPECT_GT(fs::file_size(folder_ / "out" / file), 100u) << file;
}

// Whether the steps succeed in real time depends on how busy the machine is, so this test asserts only what
// must always hold; TwoRunsGiveTheSameBitsButForWallClocks has the verdict of the same scene in lockstep.
TEST_F(Scenario, ARealTimeRunReportsItsTimingAndExitsWithItsVerdict) {
  const Ran ran = run("assemble " + kScenes + "peg_in_hole/scene.toml --out out --no-pictures --real-time");
  const json data = read("out/assemble.json");
  bool is_good = data["completed"].get<bool>();
  for (const json& step : data["steps"])
    is_good = is_good && step["completed"].get<bool>() &&
              step["max_penetration_m"].get<double>() <= step["penetration_limit_m"].get<double>() &&
              step["rest_drift_m"].get<double>() <= 5e-6;
  EXPECT_EQ(ran.status, is_good ? 0 : 1) << ran.out << ran.err;
  const json& haptic = data["wall"]["haptic"];
  const long ticks = data["haptic"]["ticks"].get<long>();
  // Both threads use one clock, so they have the same number of periods, except for a part of a period at the
  // end.
  const long periods = ticks + haptic["missed"].get<long>(),
             steps =
                 data["physics"]["ticks"].get<long>() + data["wall"]["physics"]["missed_periods"].get<long>();
  EXPECT_GT(ticks, 1000);
  // The haptic loop continues while the step is judged and the next field is built, which takes more than a
  // second. The loop's periods cover 99 % of this run; they would cover 76 % if the loop stopped while the
  // field is built.
  EXPECT_GT(static_cast<double>(periods) / data["haptic"]["rate_hz"].get<double>(),
            0.9 * data["wall"]["run_s"].get<double>());
  EXPECT_EQ(data["wall"]["missed_while_cooking"].size(), data["steps"].size());
  EXPECT_NEAR(static_cast<double>(periods), static_cast<double>(steps), 0.05 * static_cast<double>(steps));
  for (const json& change : data["wall"]["physics"]["load_changes"])  // a busy machine may cause some
    for (const char* key : {"time_s", "from", "to", "is_done", "why", "cost", "unseen_bound_m", "misread_m"})
      EXPECT_TRUE(change.contains(key)) << key;
  EXPECT_NE(ran.out.find("s behind the clock"), std::string::npos) << ran.out;
  long by_cause = 0;
  for (const json& missed : haptic["missed_by"]) by_cause += missed.get<long>();
  EXPECT_EQ(by_cause, haptic["missed"].get<long>());
  for (const char* what : {"tick_us", "late_us", "response_us"}) {
    EXPECT_LE(haptic[what]["p50"].get<double>(), haptic[what]["p99"].get<double>()) << what;
    EXPECT_LE(haptic[what]["p99"].get<double>(), haptic[what]["max"].get<double>()) << what;
  }
  EXPECT_FALSE(haptic["worst"]["cause"].get<std::string>().empty());
  EXPECT_EQ(haptic["has_priority"].get<bool>() && haptic["has_locked_memory"].get<bool>(),
            haptic["warnings"].empty());
  EXPECT_NE(ran.out.find("haptic loop: "), std::string::npos) << ran.out;
}

TEST_F(Scenario, SlowPhysicsWithLocalContactCompletesThePegToo) {
  writePegScene("pose = {position = [0, 0, -15]}\n",
                "clearance = 0.05\n[fidelity]\nphysics_rate_hz = 100\nhaptic_rate_hz = 1000\n");
  const Ran ran = run("assemble scene.toml --out out --no-pictures --local-contact");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;  // in lockstep, so every machine gives this result
  const json data = read("out/assemble.json");
  EXPECT_TRUE(data["completed"].get<bool>()) << ran.out;
  EXPECT_LE(data["steps"][0]["max_penetration_m"].get<double>(), 10e-6);
  EXPECT_LE(data["steps"][0]["rest_drift_m"].get<double>(), 5e-6);  // measured 1.5 um
  EXPECT_LE(data["energy"]["injected_J"].get<double>(), 1e-3);
  EXPECT_EQ(data["local_contact"]["held_ticks"].get<long>(), 0);
  EXPECT_GT(data["local_contact"]["greatest_jump_m"].get<double>(), 0) << "local contact had no effect";
}

// Surfaces that are not modelled are out of reach of every moving part, so no bit of the run changes.
TEST_F(Scenario, ModellingOnlyWhatTheSceneRequiresGivesTheSameRunForLessMemory) {
  const std::string scene = "assemble " + kScenes + "peg_in_hole/scene.toml --no-pictures --out ";
  ASSERT_EQ(run(scene + "spared").status, 0);
  ASSERT_EQ(run(scene + "all --model-everything").status, 0);
  EXPECT_EQ(slurp(folder_ / "spared/trace.csv"), slurp(folder_ / "all/trace.csv"));
  EXPECT_EQ(slurp(folder_ / "spared/steps.csv"), slurp(folder_ / "all/steps.csv"));
  const json spared = read("spared/assemble.json"), all = read("all/assemble.json");
  EXPECT_EQ(spared["widened"].get<int>(), 0);
  // Measured: 2.8 of 8.0 MB, and 2780 of 12843 points.
  EXPECT_LT(spared["modelled"]["bytes"].get<double>(), 0.5 * all["modelled"]["bytes"].get<double>());
  EXPECT_LT(spared["modelled"]["field_points"].get<double>(),
            0.4 * all["modelled"]["field_points"].get<double>());
}

TEST_F(Scenario, ExplainPrintsWhatIsModelledOfTheBearingBlockAndWhatThatSaves) {
  const Ran ran = run("explain " + kScenes + "bearing_block/scene.toml --measure --json explain.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const char* words :
       {"housing", "near 9 paths", "shares the models of dowel_1",
        "no later step comes near the part, so it is never cooked", "with --model-everything"})
    EXPECT_NE(ran.out.find(words), std::string::npos) << words << ran.out;
  const json data = read("explain.json");
  EXPECT_EQ(data["parts"].size(), 10u);
  EXPECT_EQ(data["steps"].size(), 9u);
  // Measured: 53 of 91 MB, and 1595 of 63973 points.
  EXPECT_LT(data["modelled"]["bytes"].get<double>(), 0.65 * data["everything"]["bytes"].get<double>());
  EXPECT_LT(data["modelled"]["field_points"].get<double>(),
            0.1 * data["everything"]["field_points"].get<double>());
  // Measured: 1.6 of 3.5 s. The times are not compared, since the machine may be busy in only one of the
  // runs.
  EXPECT_GT(data["wall"]["cook_s"].get<double>(), 0);
  EXPECT_GT(data["wall"]["everything"]["cook_s"].get<double>(), 0);
}

// One line for each of many plates would hide the parts that are modelled.
TEST_F(Scenario, ExplainPutsManyPartsThatNothingComesNearIntoOneRow) {
  const auto withPlates = [this](int count) {
    std::string scene = "unit = \"mm\"\n";
    for (int i = 0; i < count; ++i)
      scene += "[[part]]\nfile = \"plate.stl\"\nname = \"plate " + std::to_string(i) +
               "\"\nfixed = true\npose = {position = [" + std::to_string(40 * i) + ", 0, 0]}\n";
    scene +=
        "[[part]]\nfile = \"pin.stl\"\npose = {position = [0, 0, 9.5]}\n"
        "[[step]]\npart = \"pin\"\napproach = [0, 0, 20]\n";
    write("plates.toml", scene);
    const Ran ran = run("explain plates.toml --json plates.json");
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.out;
  };
  // Plate 0 is near the pin and the others are equal; twelve others still have rows of their own.
  EXPECT_EQ(withPlates(13).find("others"), std::string::npos);
  const std::string out = withPlates(14);
  // The row is in the table of parts, with the triangles of all thirteen plates, and in the table of steps.
  const std::size_t row = out.find("plate 1 and 12 others  neither");
  ASSERT_NE(row, std::string::npos) << out;
  EXPECT_NE(out.substr(row, out.find('\n', row) - row).find(" 156 "), std::string::npos) << out;
  EXPECT_NE(out.find("plate 1 and 12 others", row + 1), std::string::npos) << out;
  EXPECT_EQ(out.find("plate 13"), std::string::npos) << out;
  EXPECT_EQ(read("plates.json")["parts"].size(), 15u);
}

// Measured: 52 MB estimated and 61 MB built; with everything modelled 122 and 120 MB; 4836 and 4982 points.
TEST_F(Scenario, ExplainEstimatesWhatItMeasures) {
  const std::string call = "explain " + kScenes + "bearing_block/scene.toml --json ";
  const Ran ran = run(call + "estimated.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("--measure"), std::string::npos) << ran.out;
  ASSERT_EQ(run(call + "measured.json --measure").status, 0);
  const json estimated = read("estimated.json"), measured = read("measured.json");
  EXPECT_TRUE(estimated["estimated"].get<bool>());
  EXPECT_FALSE(measured["estimated"].get<bool>());
  for (const char* of : {"modelled", "everything"})
    for (const char* key : {"bytes", "points", "field_points"})
      EXPECT_NEAR(estimated[of][key].get<double>() / measured[of][key].get<double>(), 1, 0.25) << of << key;
  for (const char* key : {"voxmaps", "pointshells"})
    EXPECT_EQ(estimated["modelled"][key], measured["modelled"][key]) << key;
  for (std::size_t s = 0; s < 9; ++s)
    EXPECT_EQ(estimated["steps"][s]["is_cooked_anew"], measured["steps"][s]["is_cooked_anew"]) << s;
}

TEST_F(Scenario, TwoRunsGiveTheSameBitsButForWallClocks) {
  for (const char* out : {"a", "b"})
    ASSERT_EQ(run("assemble " + kScenes + "peg_in_hole/scene.toml --out " + out).status, 0);
  std::size_t compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "a")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".png" && extension != ".csv" && extension != ".svg") continue;
    const fs::path twin = folder_ / "b" / fs::relative(entry.path(), folder_ / "a");
    EXPECT_EQ(slurp(entry.path()), slurp(twin)) << entry.path();
    ++compared;
  }
  EXPECT_GE(compared, 2u + 5u);  // trace and steps; two pictures of the assembly and three of the step
  EXPECT_EQ(withoutWall(read("a/assemble.json")).dump(), withoutWall(read("b/assemble.json")).dump());
}

TEST_F(Scenario, ARecordedRunReplaysToTheSameReport) {
  ASSERT_EQ(
      run("assemble " + kScenes + "peg_in_hole/scene.toml --no-pictures --out a --record run.mcap").status,
      0);
  const Ran whole = run("replay run.mcap --json b.json --csv tables --out again");
  EXPECT_EQ(whole.status, 0) << whole.out << whole.err;
  EXPECT_NE(whole.out.find("the same bits"), std::string::npos) << whole.out;
  EXPECT_EQ(withoutWall(read("a/assemble.json")).dump(), withoutWall(read("b.json")).dump());
  EXPECT_EQ(slurp(folder_ / "a/trace.csv"), slurp(folder_ / "again/trace.csv"));
  for (const char* table : {"device_read", "device_write", "run_event", "run_trace", "about"})
    EXPECT_GT(fs::file_size(folder_ / "tables" / (std::string(table) + ".csv")), 100u) << table;

  const std::string bytes = slurp(folder_ / "run.mcap");
  write("cut.mcap", bytes.substr(0, bytes.size() / 2));
  const Ran cut = run("replay cut.mcap");
  EXPECT_EQ(cut.status, 1) << cut.out << cut.err;
  EXPECT_NE(cut.err.find("cut.mcap ends in the middle of a record (byte "), std::string::npos) << cut.err;
  EXPECT_NE(cut.out.find("the same bits"), std::string::npos) << cut.out;
}

TEST_F(Scenario, ATargetBelowTheBottomIsNotReachedAndTheReasonIsGiven) {
  writePegScene("", "target = {position = [0, 0, -17]}\ntimeout_s = 4\n");
  const Ran ran = run("assemble scene.toml --out out");
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  const json data = read("out/assemble.json");
  EXPECT_FALSE(data["completed"].get<bool>());
  EXPECT_NE(data["steps"][0]["failure_reason"].get<std::string>(), "");
}

TEST_F(Scenario, APartThatDriftsAfterReleaseIsNotShown) {
  // The peg is released at half depth with nothing below it, so it falls.
  writePegScene("", "start = {position = [0, 0, -5]}\ntarget = {position = [0, 0, -8]}\n");
  const Ran ran = run("assemble scene.toml --out out");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  const json step = read("out/assemble.json")["steps"][0];
  const std::string reason = step["reason"], moved = "; then it moved by ";
  const std::size_t at = reason.find(moved);
  ASSERT_NE(at, std::string::npos) << reason;
  // The text has the value in mm, with two decimals.
  EXPECT_NEAR(std::stod(reason.substr(at + moved.size())), 1e3 * step["rest_drift_m"].get<double>(), 0.006);
  // The peg comes to rest on the bottom of the hole, 7 mm below its target. While the hand opens, the peg
  // sinks by about 1 mm, depending on where it leans; the drift is measured from then on.
  constexpr double kFall_m = 7e-3;
  EXPECT_NEAR(step["final_error_m"].get<double>(), kFall_m, 10e-6);
  EXPECT_GT(step["rest_drift_m"].get<double>(), kFall_m / 2);
  EXPECT_LT(step["rest_drift_m"].get<double>(),
            kFall_m + 0.5e-3);  // the peg is released too high by five times see_error_m
  EXPECT_NE(ran.out.find(": nothing holds it there"), std::string::npos) << ran.out;
}

TEST_F(Scenario, APathLongerThanTheDevicesWorkspaceIsRefusedWithoutIndexing) {
  writePegScene(
      "",
      "start = {position = [0, 0, 600]}\ntarget = {position = [0, 0, -15]}\n[device]\nindexing = false\n");
  expectRefused("assemble scene.toml --out out", "longer than the device's workspace");
}

TEST_F(Scenario, APartThatStartsDeepInsideIsRefusedToo) {
  write("plate.stl", stlBox(Vec3(30, 30, 30)));
  write("pin.stl", stlBox(Vec3(6, 6, 6)));
  write("scene.toml",
        "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n"
        "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 0]}\ntarget = {position = [0, 0, 30]}\n");
  // A cube of 6 mm is in the middle of a cube of 30 mm, so its faces are 12 mm below the other faces.
  expectRefused("assemble scene.toml --out out", "part 'pin': starts 12000 um inside 'plate'");
}

TEST_F(Scenario, APartThatStartsInsideAnotherIsRefusedByName) {
  writePegScene("pose = {position = [0, 0, -15]}\n", "start = {position = [1, 0, -10]}\n");
  expectRefused("assemble scene.toml --out out", "part 'peg': starts");
}

// The path of the second step leads through the plate, and its time limit would last for hours.
TEST_F(Scenario, AStoppedRunKeepsTheStepsThatWereDoneAndSaysWhere) {
  write("steps.toml",
        "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n"
        "[[part]]\nfile = 'pin.stl'\nname = 'near'\n[[part]]\nfile = 'pin.stl'\nname = 'far'\n"
        "[[step]]\npart = 'near'\nstart = {position = [5, 0, 12]}\n"
        "target = {position = [5, 0, 9]}\n"
        "timeout_s = 0.1\n"
        "[[step]]\npart = 'far'\nstart = {position = [-5, 0, -12]}\ntarget = {position = [-5, 0, 9]}\n"
        "timeout_s = 10000\n");
  write("stop.sh",
        "'" VPS_PROGRAM
        "' assemble steps.toml --out run --no-pictures >out.txt 2>err.txt &\n"
        "while [ ! -e run/unfinished.json ] && kill -0 $!; do sleep 0.05; done\nkill -TERM $!\nwait $!\n");
  std::system(("cd '" + folder_.string() + "' && XDG_CACHE_HOME='" + folder_.string() + ".cache' sh stop.sh")
                  .c_str());
  EXPECT_NE(slurp(folder_ / "out.txt").find("the results so far are in run/unfinished.json"),
            std::string::npos)
      << slurp(folder_ / "out.txt") << slurp(folder_ / "err.txt");
  const json kept = json::parse(slurp(folder_ / "run/unfinished.json"));
  ASSERT_EQ(kept["steps"].size(), 1u);
  EXPECT_EQ(kept["steps"][0]["part"], "near");
  const std::string page = slurp(folder_ / "run/unfinished.html");
  EXPECT_NE(page.find("1 of 2 steps are finished"), std::string::npos);
  EXPECT_NE(page.find("near"), std::string::npos);
}

}  // namespace
}  // namespace vps
