// SPDX-License-Identifier: BSD-3-Clause
// The program `vps`: the command line, and the one place where errors become a line and an exit status.
// The one file that includes CLI11.
#include <CLI/CLI.hpp>

#include <functional>
#include <new>

#include "commands.h"
#include "terminal.h"
#include "vps/load_error.h"

namespace vps::viewer {

namespace {

int couldNot(const std::string& words) {
  say(words);
  return kCouldNot;
}

using Run = std::function<int()>;

/// The command line and what it chose. Subcommands keep references into the arguments: neither copies nor
/// moves.
class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", std::string("vps ") + VPS_VERSION);
    app_.require_subcommand(1);
    app_.footer(
        "Exit status: 0 done and good, 1 done but the parts do not fit or a bound was missed, 2 could not.\n"
        "Lengths carry a unit: 0.2mm, 20um, 0.01m. Example:\n  vps assemble scenes/peg_in_hole/scene.toml "
        "--out out");
    addAssemble();
    addReplay();
    addSimulate();
    addQuery();
    addImport();
    addSnapshot();
    addComing("check", "fit of an assembly as designed: interference, clearance, play",
              "vps check bearing_block.step");
    addExplain();
    addTrade();
    addComing("view", "opens a window on a scene", "vps view scene.toml");
    addDevice();
    addComing("render", "the haptic rendering node", "vps render scene.toml");
    addComing("watch", "the viewer's node", "vps watch");
  }
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  int run(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& help_or_version) {
      return app_.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
      const auto chosen = app_.get_subcommands();
      const std::string help =
          chosen.empty() ? "vps --help" : "vps " + chosen.front()->get_name() + " --help";
      return couldNot(reason(error) + "; see " + help);
    }
    return run_();
  }

 private:
  CLI::App* add(const std::string& name, const std::string& does, const std::string& example, Run run) {
    CLI::App* command = app_.add_subcommand(name, does);
    command->footer("Example:\n  " + example);
    command->callback([this, run = std::move(run)] { run_ = run; });
    return command;
  }

  /// CLI11 calls an unknown command a missing one.
  std::string reason(const CLI::ParseError& error) const {
    const auto left_over = app_.remaining();
    if (!app_.get_subcommands().empty() || left_over.empty()) return error.what();
    const std::string& first = left_over.front();
    return (first.starts_with('-') ? "unknown option '" : "unknown command '") + first + "'";
  }

  static void addFidelity(CLI::App* command, FidelityArguments& given) {
    command->add_option("--fidelity", given.preset, "preset: fast, normal, fine");
    command->add_option("--voxel", given.voxel, "grid step of voxmaps, with unit");
    command->add_option("--spacing", given.spacing, "distance between shell points, with unit");
    command->add_option("--sides", given.sides,
                        "one: moving points against the fixed field; both: the reverse too");
  }

  static void addCache(CLI::App* command, std::string& folder) {
    command->add_option("--cache", folder, "keep voxmaps there, and take them from there")->type_name("DIR");
  }

  static void addJson(CLI::App* command, std::string& json) {
    command->add_option("--json", json, "write the numbers there")->type_name("FILE");
  }

  static void addEverything(CLI::App* command, bool& models_everything) {
    command->add_flag("--model-everything", models_everything,
                      "spare nothing: a map and a shell for each part, none shared, nothing left out");
  }

  void addExplain() {
    CLI::App* command =
        add("explain", "what of a scene is modelled, what not, why, and what it costs",
            "vps explain scenes/bearing_block/scene.toml", [this] { return runExplain(explain_); });
    command->add_option("scene", explain_.scene, "scene file")->required()->type_name("SCENE");
    command->add_flag("--simulate", explain_.is_for_simulate,
                      "for vps simulate; left out: for vps assemble, if the scene has steps");
    addEverything(command, explain_.models_everything);
    addFidelity(command, explain_.fidelity);
    addCache(command, explain_.cache);
    addJson(command, explain_.json);
  }

  void addAssemble() {
    CLI::App* command =
        add("assemble", "runs the assembly procedure by contact; writes report, pictures and data",
            "vps assemble scenes/bearing_block/scene.toml --out out/demo",
            [this] { return runAssemble(assemble_); });
    command->add_option("scene", assemble_.scene, "scene file")->required()->type_name("SCENE");
    command->add_option("--out", assemble_.out, "folder for the results")
        ->capture_default_str()
        ->type_name("DIR");
    command->add_flag("!--no-pictures", assemble_.has_pictures, "tables, plots and data only");
    command->add_flag("--stop-at-failure", assemble_.stops_at_failure, "end at the first step that fails");
    command->add_flag("--local-contact", assemble_.has_local_contact,
                      "the haptic loop moves the part by itself between physics steps; for slow physics");
    command->add_flag("--real-time", assemble_.is_real_time,
                      "by the clock, haptic loop and physics each on a thread of its own; not repeatable");
    command->add_flag(
        "!--no-degrade", assemble_.degrades,
        "with --real-time: a run that cannot hold its rate goes on as it is, and counts what it "
        "missed");
    command
        ->add_option("--record", assemble_.record,
                     "record the run there (MCAP), scene and meshes included, for vps replay")
        ->type_name("FILE");
    addEverything(command, assemble_.models_everything);
    addFidelity(command, assemble_.fidelity);
    addCache(command, assemble_.cache);
    addJson(command, assemble_.json);
  }

  void addReplay() {
    CLI::App* command =
        add("replay", "runs a recording again, bit for bit, and says at which tick it departs if it does",
            "vps replay run.mcap --csv tables", [this] { return runReplay(replay_); });
    command->add_option("recording", replay_.recording, "what vps assemble --record wrote")
        ->required()
        ->type_name("RECORDING");
    command->add_option("--csv", replay_.csv, "write the recorded channels there as tables")
        ->type_name("DIR");
    command->add_flag("--no-run", replay_.is_tables_only, "with --csv: only the tables");
    command->add_option("--out", replay_.out, "write the report there, as vps assemble does")
        ->type_name("DIR");
    addCache(command, replay_.cache);
    addJson(command, replay_.json);
  }

  void addSimulate() {
    CLI::App* command = add("simulate", "lets a scene's bodies move under gravity, without a hand",
                            "vps simulate scenes/peg_in_hole/scene.toml --seconds 2 --trace trace.csv",
                            [this] { return runSimulate(simulate_); });
    command->add_option("scene", simulate_.scene, "scene file")->required()->type_name("SCENE");
    command->add_option("--seconds", simulate_.seconds, "simulated time")
        ->capture_default_str()
        ->type_name("S");
    command->add_flag("--real-time", simulate_.is_real_time,
                      "by the clock: each step when it is due; misses are counted");
    command->add_option("--trace", simulate_.trace, "one CSV row per step")->type_name("FILE");
    addEverything(command, simulate_.models_everything);
    addFidelity(command, simulate_.fidelity);
    addCache(command, simulate_.cache);
    addJson(command, simulate_.json);
  }

  void addQuery() {
    CLI::App* command = add(
        "query", "contact of mesh B with mesh A at given poses of B in A",
        "vps query hole.stl peg.stl --units mm --pose 0,0,-0.0149,0,0,0,1 --voxel 0.1mm --json contact.json",
        [this] { return runQuery(query_); });
    command->add_option("mesh_a", query_.mesh_a, "the fixed mesh")->required()->type_name("MESH_A");
    command->add_option("mesh_b", query_.mesh_b, "the moving mesh")->required()->type_name("MESH_B");
    CLI::Option* pose = command->add_option(
        "--pose", query_.pose, "x,y,z,qx,qy,qz,qw of B in A, metres (left out: as in the files)");
    command->add_option("--poses", query_.poses, "a file with a pose on each line")
        ->type_name("FILE")
        ->excludes(pose);
    command->add_option("--units", query_.units, "of meshes that do not say: mm, cm, m, um, inch");
    CLI::Option* points = command->add_option("--points", query_.fidelity.points,
                                              "about so many shell points, instead of --spacing");
    command->add_option("--stiffness", query_.stiffness_N_per_m3, "penalty stiffness per area [N/m^3]")
        ->capture_default_str();
    command
        ->add_option("--budget-points", query_.budget_points,
                     "read no more points a pose and side; says what was left coarse")
        ->check(CLI::Range(1, 1000000000));
    command->add_option("--budget-us", query_.budget_us, "stop refining after so many microseconds a side")
        ->check(CLI::Range(1.0, 1e9));
    command->add_option("--repeats", query_.repeats, "timed runs of each pose (left out: 100 runs in all)")
        ->check(CLI::Range(1, 1000000));
    addFidelity(command, query_.fidelity);
    addCache(command, query_.cache);
    points->excludes(command->get_option("--spacing"))->check(CLI::Range(1, 100000000));
    addJson(command, query_.json);
  }

  void addTrade() {
    CLI::App* command =
        add("trade", "measures speed against accuracy on a scene",
            "vps trade scenes/peg_in_hole/scene.toml --out out/trade", [this] { return runTrade(trade_); });
    command->add_option("scene", trade_.scene, "scene file")->required()->type_name("SCENE");
    command->add_flag("--thorough", trade_.is_thorough,
                      "all steps and settings, however long it takes (left out: 50 s in all)");
    command->add_option("--out", trade_.out, "folder for plot, trade.csv and trade.json")->type_name("DIR");
    command->add_option("--budget-hz", trade_.budget_hz, "pick a fidelity for this physics rate, and stop")
        ->check(CLI::Range(1.0, 1e6));
    command->add_option("--tolerance", trade_.tolerance,
                        "pick one that reads depth to this length, with unit");
    command->add_option("--memory", trade_.memory, "pick one whose models take no more: 64MB, 1GB");
    command->add_option("--csv", trade_.csv, "write the table there")->type_name("FILE");
    addFidelity(command, trade_.fidelity);
    addJson(command, trade_.json);
  }

  void addImport() {
    CLI::App* command = add("import", "turns a CAD file into a scene: parts, poses, steps proposed",
                            "vps import assembly.step -o my_scene", [this] { return runImport(import_); });
    command->add_option("cad", import_.cad, "STEP, IGES, glTF, STL, OBJ, PLY, Inventor, ...")
        ->required()
        ->type_name("CAD");
    command->add_option("-o,--out", import_.out, "folder for scene.toml and meshes")
        ->required()
        ->type_name("DIR");
    command->add_option("--units", import_.units, "of files that do not say: mm, cm, m, um, inch");
    command->add_option("--deflection", import_.deflection,
                        "greatest distance of triangles from curved faces, with unit");
    command->add_flag("--force", import_.is_forced, "over a scene.toml that is there");
    addJson(command, import_.json);
  }

  void addSnapshot() {
    CLI::App* command = add("snapshot", "a picture of a scene's finished assembly, without a display",
                            "vps snapshot scenes/peg_in_hole/scene.toml -o peg.png --view front --section",
                            [this] { return runSnapshot(snapshot_); });
    command->add_option("scene", snapshot_.scene, "scene file")->required()->type_name("SCENE");
    command->add_option("-o,--out", snapshot_.out, "picture to write")->type_name("FILE.png");
    command->add_option("--size", snapshot_.size, "width and height in pixels")
        ->capture_default_str()
        ->type_name("WxH");
    command->add_option("--view", snapshot_.view, "where from")
        ->capture_default_str()
        ->check(CLI::IsMember(viewNames()));
    command->add_flag("--section", snapshot_.has_section, "cut away the half in front");
    command->add_option("--compare", snapshot_.compare, "exit 1 if the picture differs from this one")
        ->type_name("IMAGE");
    command
        ->add_option("--tolerance", snapshot_.tolerance,
                     "difference of a channel that counts as equal, 0 to 255")
        ->capture_default_str()
        ->check(CLI::Range(0, 255));
    command->add_option("--difference", snapshot_.difference, "picture of the difference to write")
        ->type_name("FILE.png");
    addJson(command, snapshot_.json);
  }

  void addDevice() {
    CLI::App* command = add("device", "the device: its figures beside the paper's (as a node: not ready)",
                            "vps device --characterise --json dual_arm.json --plot figure5",
                            [this] { return runDevice(device_); });
    command->add_flag("--list", device_.is_list, "the kinds of device for a scene's [device] kind");
    CLI::Option* characterise = command->add_flag("--characterise", device_.is_characterise,
                                                  "the dual arm's own Table 1, and figure 5");
    command->add_option("--parameters", device_.parameters, "a device's file, over the built-in one")
        ->type_name("FILE.toml")
        ->needs(characterise);
    command->add_option("--plot", device_.plot, "figure 5 as .png and .svg; '' for none")
        ->capture_default_str()
        ->type_name("NAME")
        ->needs(characterise);
    addJson(command, device_.json);
    command->get_option("--json")->needs(characterise);
  }

  /// A command that is to come: it is there, says so, and is no success.
  void addComing(const std::string& name, const std::string& does, const std::string& example) {
    CLI::App* command = add(name, does + " (not ready)", example, [name, does] {
      return couldNot(name + " is not ready yet; it is to be: " + does);
    });
    command->allow_extras();
  }

  CLI::App app_{"Voxmap-PointShell contact on CAD parts: assemble, replay, simulate, query, import, show.",
                "vps"};
  Run run_;
  AssembleArguments assemble_;
  ReplayArguments replay_;
  SimulateArguments simulate_;
  ExplainArguments explain_;
  QueryArguments query_;
  TradeArguments trade_;
  ImportArguments import_;
  SnapshotArguments snapshot_;
  DeviceArguments device_;
};

int run(int argc, char** argv) {
  try {
    catchStop();
    return CommandLine().run(argc, argv);
  } catch (const std::bad_alloc&) {
    return couldNot("not enough memory; use a coarser --voxel and --spacing, or a smaller part");
  } catch (const std::exception& error) {  // LoadError, Stopped, and what libraries throw
    return couldNot(error.what());
  } catch (...) {
    return couldNot("an error without a name; please report it with the command that gave it");
  }
}

}  // namespace

}  // namespace vps::viewer

int main(int argc, char** argv) {
  return vps::viewer::run(argc, argv);
}
