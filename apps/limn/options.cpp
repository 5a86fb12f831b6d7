#include "apps/limn/options.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>

#include "apps/limn/help.h"
#include "apps/limn/names.h"
#include "apps/limn/values.h"
#include "apps/limn/version.h"
#include "apps/scene/image.h"
#include "apps/scene/nearest.h"
#include "raster/base/workers.h"

namespace limn::program {
namespace {

constexpr int kMostThreads = 1024;

/// Options of one group of the help, each read by a function that throws UsageError.
class Group {
 public:
  Group(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}

  CLI::Option* add(const std::string& option, const std::string& type, const std::string& help,
                   const std::string& standard, const std::function<void(const std::string&)>& read) {
    const auto readNamed = [option, read](const std::string& text) {
      try {
        read(text);
      } catch (const UsageError& error) {
        throw UsageError(option + ": " + error.what());
      }
    };
    CLI::Option* added = app_.add_option_function<std::string>(option, readNamed, help);
    added->type_name(type)->group(name_);
    if (!standard.empty()) added->default_str(standard);
    return added;
  }

  CLI::Option* addNumber(const std::string& option, const std::string& type, const std::string& help,
                         double& value) {
    return add(option, type, help, numberText(value),
               [&value](const std::string& text) { value = parseNumber(text); });
  }

  CLI::Option* addSwitch(const std::string& option, const std::string& help, bool& value) {
    static const std::vector<std::string> kNames = {"off", "on"};
    return add(option, "on|off", help, value ? "on" : "off",
               [&value](const std::string& text) { value = parseChoice(text, kNames) == 1; });
  }

  template <class Choice>
  CLI::Option* addChoice(const std::string& option, const std::string& help,
                         const std::vector<std::string>& names, Choice& value) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : "|") + name;
    return add(
        option, all, help, names[static_cast<std::size_t>(value)],
        [&value, &names](const std::string& text) { value = static_cast<Choice>(parseChoice(text, names)); });
  }

  CLI::Option* addFlag(const std::string& option, const std::string& help, bool& value) {
    return app_.add_flag(option, value, help)->group(name_);
  }

 private:
  CLI::App& app_;
  std::string name_;
};

float positive(const std::string& text, bool zeroToo) {
  constexpr double kLargest = 1e9;
  const double number = parseNumber(text);
  const float value = static_cast<float>(number);  // 0 for what is too small for a float
  if (number < 0.0 || number > kLargest || (value == 0.0f && !zeroToo))
    throw UsageError("'" + text + "' is out of range; give a number " +
                     (zeroToo ? "from 0 to 1e9" : "above 0, at most 1e9"));
  return value;
}

void addModel(CLI::App& app, std::string& model) {
  app.add_option("MODEL", model,
                 "a .gltf or .glb file, - for a GLB on standard input, or builtin:NAME (see `limn models`)")
      ->default_str(model)
      ->type_name("");
}

void addPictureOptions(CLI::App& app, RenderOptions& o) {
  Group picture(app, "Picture");
  picture.add("--size", "WxH", "pixels", "1280x800",
              [&o](const std::string& text) { std::tie(o.job.width, o.job.height) = parseSize(text); });
  picture.add("--samples", "1|4|8", "antialiasing samples per pixel", "4", [&o](const std::string& text) {
    const std::vector<std::string> names = {"1", "4", "8"};
    parseChoice(text, names);
    o.job.settings.samples = static_cast<int>(parseInteger(text, 1, 8));
  });
  picture.add("--background", "COLOR", "#rrggbb, #rrggbbaa, a basic name like white, or transparent",
              "transparent", [&o](const std::string& text) { o.job.settings.background = parseColor(text); });
  picture.add(
      "--overlay", "wire,edges,contour,features",
      "lines over the picture: the edges of all drawn triangles; silhouette edges coloured by their "
      "silhouetteness, from blue to red; where the shading normals turn away (curves: bridges and segments); "
      "creases",
      "none", [&o](const std::string& text) {
        for (const int choice : parseChoices(text, overlayNames()))
          o.job.settings.overlays[static_cast<std::size_t>(choice)] = true;
      });
  picture.add(
      "--light", "headlight|file|x,y,z",
      "a light at the eye, the file's own (or one from the upper right where it has none), or a direction "
      "towards the light",
      "file", [&o](const std::string& text) {
        scene::FrameSettings& settings = o.job.settings;
        if (text == "headlight" || text == "file") {
          settings.light = text == "file" ? scene::LightChoice::kFile : scene::LightChoice::kHeadlight;
          return;
        }
        settings.light = scene::LightChoice::kDirection;
        settings.lightDirection = parseVector(text);
        if (settings.lightDirection == glm::dvec3(0.0))
          throw UsageError("the direction of the light is zero");
      });
}

/// What moves. Returns the group for more of it.
Group addMotionOptions(CLI::App& app, JobOptions& o) {
  Group frames(app, "Frames and motion");
  frames.add("--turntable", "N", "N frames of one turn about the up axis", "", [&o](const std::string& text) {
    o.turntable = static_cast<int>(parseInteger(text, 1, kMostFrames));
  });
  CLI::Option* animation =
      frames.add("--animation", "NAME|INDEX", "an animation of the file; its frames run over --time", "none",
                 [&o](const std::string& text) { o.animation = text; });
  frames
      .add("--fps", "F", "frames per second of the animation", "24",
           [&o](const std::string& text) { o.fps = static_cast<double>(positive(text, false)); })
      ->needs(animation);
  frames
      .add("--time", "A:B", "seconds of the animation to draw", "whole animation",
           [&o](const std::string& text) { o.times = parseTimes(text); })
      ->needs(animation);
  return frames;
}

void addCameraOptions(CLI::App& app, JobOptions& o) {
  Group automatic(app, "Camera, framed automatically");
  CLI::Option* azimuth = automatic.addNumber(
      "--azimuth", "DEG", "0 looks along -z, positive turns the eye to the right", o.azimuthDegrees);
  CLI::Option* elevation =
      automatic.addNumber("--elevation", "DEG", "positive raises the eye", o.elevationDegrees);
  CLI::Option* zoom = automatic.add("--zoom", "F", "magnification", "1", [&o](const std::string& text) {
    o.zoom = static_cast<double>(positive(text, false));
  });
  Group own(app, "Camera of your own");
  CLI::Option* eye = own.add("--eye", "x,y,z", "where the eye is", "",
                             [&o](const std::string& text) { o.eye = parseVector(text); });
  own.add("--target", "x,y,z", "what it looks at", "centre of the scene",
          [&o](const std::string& text) { o.target = parseVector(text); })
      ->needs(eye);
  own.add("--up", "x,y,z", "what is up", "0,1,0", [&o](const std::string& text) { o.up = parseVector(text); })
      ->needs(eye);
  CLI::Option* fov = own.add("--fov", "DEG", "vertical field of view", "30", [&o](const std::string& text) {
    o.fovDegrees = parseNumber(text);
    if (!(o.fovDegrees > 0.0 && o.fovDegrees < 180.0))
      throw UsageError("'" + text + "' is no field of view; give degrees above 0 and below 180");
  });
  CLI::Option* ortho =
      own.add("--ortho", "HEIGHT|fit", "orthographic, so many units high or just high enough", "",
              [&o](const std::string& text) {
                o.orthoHeight = text == "fit" ? -1.0 : static_cast<double>(positive(text, false));
              });
  CLI::Option* camera = own.add("--camera", "NAME|INDEX", "a camera of the file", "none",
                                [&o](const std::string& text) { o.camera = text; });
  fov->excludes(ortho);
  for (CLI::Option* option : {azimuth, elevation, zoom}) option->excludes(eye)->excludes(camera);
  for (CLI::Option* option : {eye, fov, ortho}) option->excludes(camera);
}

void addSilhouetteOptions(CLI::App& app, JobOptions& o) {
  silhouette::Parameters& p = o.settings.refinement;
  Group group(app, "Silhouettes");
  group.addChoice("--method", "how triangles are smoothed", methodNames(), p.method);
  CLI::Option* tolerance =
      group.add("--tolerance", "PX", "guaranteed distance from the exact curves in pixels", "0.25",
                [&p](const std::string& text) { p.tolerance = positive(text, true); });
  group
      .add("--segments", "N", "a fixed number of segments per edge instead", "",
           [&p](const std::string& text) {
             p.segments = static_cast<int>(parseInteger(text, 1, silhouette::kMaxSegments));
           })
      ->excludes(tolerance);
  CLI::Option* beta =
      group.add("--beta", "B", "width of the transition between smooth and flat edges", numberText(p.beta),
                [&p](const std::string& text) { p.beta = positive(text, true); });
  group
      .add("--wedge", "DEG", "the same by the angle between the faces of each edge", "",
           [&p](const std::string& text) {
             p.wedgeDegrees = positive(text, false);
             if (p.wedgeDegrees >= 180.0f)
               throw UsageError("'" + text + "' is no wedge angle; give degrees below 180");
           })
      ->excludes(beta);
  group.addChoice("--silhouetteness", "what tells a silhouette edge", silhouettenessNames(),
                  p.silhouetteness);
  group.addChoice("--tangents", "end tangents of edge curves", tangentsNames(), p.tangents);
  group.addSwitch("--robust", "limit curves where normals and triangles disagree", p.robust);
  group.addChoice("--shading-normals", "normals inside refined triangles", shadingNormalsNames(),
                  p.shadingNormals);
  group.addSwitch("--features", "smooth creases", p.features);
  group.addSwitch("--boundaries", "smooth open edges", p.boundaries);
  group.add("--crease", "DEG", "for files without normals: edges that turn more are creases",
            numberText(o.creaseDegrees), [&o](const std::string& text) {
              o.creaseDegrees = parseNumber(text);
              if (!(o.creaseDegrees >= 0.0 && o.creaseDegrees <= 180.0))
                throw UsageError("'" + text + "' is no angle between faces; give degrees from 0 to 180");
            });
}

void addOutputOptions(CLI::App& app, RenderOptions& o) {
  Group output(app, "Output");
  output.add("-o,--output", "OUT",
             "a pattern like frames/%04d.png or frames/####.png, a file name, or - for standard output", "",
             [&o](const std::string& text) { o.output = text; });
  output.add("--format", "png|rgba", "rgba: raw rows of 8-bit RGBA, for a pipe", "png",
             [&o](const std::string& text) {
               const std::vector<std::string> names = {"png", "rgba"};
               o.rgba = parseChoice(text, names) == 1;
             });
  output.add("--compress", "0..12", "of PNG files: 0 is fastest, 12 smallest", "1",
             [&o](const std::string& text) {
               o.compression = static_cast<int>(parseInteger(text, 0, scene::kHighestCompression));
             });
  output.add("--aov", "depth,normal,id", "16-bit pictures of these beside each frame, like 0001.depth.png",
             "none", [&o](const std::string& text) { o.aovs = parseAovs(text); });
  output.addFlag("--hash", "print a line per frame: its number and the XXH3-128 of its RGBA8 rows", o.hash);
  output.add("--stats", "FILE.json", "write counts, times by stage and memory", "",
             [&o](const std::string& text) { o.statistics = text; });

  Group farms(app, "Scripts and farms");
  farms.add("--threads", "N", "threads that work, in all; the picture does not depend on it",
            std::to_string(o.threads), [&o](const std::string& text) {
              o.threads = static_cast<int>(parseInteger(text, 1, kMostThreads));
            });
  farms.add("--shard", "I/N", "draw only every N-th frame of the list, from the I-th on", "1/1",
            [&o](const std::string& text) { o.shard = parseShard(text); });
  farms.addFlag("--skip-existing", "leave out frames whose files are there, whole and of the same job",
                o.skipExisting);
  farms.add("--manifest", "FILE.json", "write the pixel hash of every frame and of the job", "",
            [&o](const std::string& text) { o.manifest = text; });
  farms.addFlag("--dry-run", "check everything and list the files, but write nothing", o.dryRun);
  farms.addFlag("--quiet", "no notes and no progress", o.quiet);
}

CLI::App* addRender(CLI::App& app, RenderOptions& o) {
  CLI::App* render = app.add_subcommand("render", "draw frames of a model");
  addModel(*render, o.job.model);
  addOutputOptions(*render, o);
  addPictureOptions(*render, o);
  addMotionOptions(*render, o.job)
      .add("--frames", "LIST", "which frames of the job to draw, like 1-10,15,20-40:2; the first is 1", "all",
           [&o](const std::string& text) { o.frames = text; });
  addCameraOptions(*render, o.job);
  addSilhouetteOptions(*render, o.job);
  render->footer(R"(Examples:
  limn render -o demo.png                                        the built-in demonstration model
  limn render duck.glb -o flat.png --method flat                 a model as it is, without smoothing
  limn render duck.glb -o frames/%04d.png --turntable 36         36 frames around it
  limn render fox.glb -o run/####.png --animation Run --fps 30   an animation of the file
  limn render duck.glb -o big.png --size 3840x2160 --tolerance 0.1 --samples 8
)");
  return render;
}

CLI::App* addRefine(CLI::App& app, RefineOptions& o) {
  CLI::App* refine = app.add_subcommand("refine", "the triangles of one view, as a GLB file");
  addModel(*refine, o.job.model);
  Group output(*refine, "Output");
  output.add("-o,--output", "OUT.glb", "the file, or - for standard output", "",
             [&o](const std::string& text) { o.output = text; });
  output.addFlag("--alpha", "add the coarse edges as lines with their silhouetteness as attribute _ALPHA",
                 o.alphas);
  output.addFlag("--quiet", "no notes", o.quiet);
  output.add(
      "--threads", "N", "threads that work, in all", std::to_string(o.threads),
      [&o](const std::string& text) { o.threads = static_cast<int>(parseInteger(text, 1, kMostThreads)); });
  output.add("--size", "WxH", "pixels of the window that --tolerance counts", "1280x800",
             [&o](const std::string& text) { std::tie(o.job.width, o.job.height) = parseSize(text); });
  addMotionOptions(*refine, o.job)
      .add("--frame", "K", "which frame of the job", "1",
           [&o](const std::string& text) { o.frame = static_cast<int>(parseInteger(text, 1, kMostFrames)); });
  addCameraOptions(*refine, o.job);
  addSilhouetteOptions(*refine, o.job);
  refine->footer(R"(Example:
  limn refine duck.glb -o refined.glb --azimuth 60 --tolerance 0.5 --alpha
)");
  return refine;
}

CLI::App* addCoarsen(CLI::App& app, CoarsenOptions& o) {
  CLI::App* coarsen = app.add_subcommand("coarsen", "a small model with the outline of a fine one");
  coarsen->add_option("FINE", o.fine, "a .gltf or .glb file, - or builtin:NAME")->required()->type_name("");
  coarsen->add_option("-o,--output", o.output, "the small model; - is standard output")
      ->required()
      ->type_name("SMALL.glb");
  Group group(*coarsen, "Coarsening");
  group.add("--triangles", "N", "aim for so many triangles in all, at least 4 per mesh", "",
            [&o](const std::string& text) {
              o.triangles = static_cast<std::size_t>(parseInteger(text, 4, 1'000'000'000));
            });
  group.add("--error", "PX", "instead: as few triangles as keep the outline within so many pixels", "",
            [&o](const std::string& text) { o.error = positive(text, false); });
  group.add("--at", "WxH", "the window whose pixels --error counts", "1280x800",
            [&o](const std::string& text) { o.at = parseSize(text); });
  group.add("--coarse", "FILE", "take this model as it is and fit curves to it, instead of simplifying FINE",
            "", [&o](const std::string& text) { o.coarse = text; });
  group.add(
      "--threads", "N", "threads that work; the same bytes for any number", std::to_string(o.threads),
      [&o](const std::string& text) { o.threads = static_cast<int>(parseInteger(text, 1, kMostThreads)); });
  group.addFlag("--quiet", "no notes and no progress", o.quiet);
  coarsen->footer(R"(Examples:
  limn coarsen statue.glb -o small.glb --triangles 500
  limn coarsen statue.glb -o small.glb --error 1 --at 800x600
  limn coarsen statue.glb -o mine.glb --coarse low-poly.glb      curves for a mesh of your own
  limn render small.glb -o small.png

Other viewers show the coarse mesh; limn reads the curves (extension LIMN_fitted_curves).
)");
  return coarsen;
}

/// What to say of arguments that no option takes.
[[noreturn]] void refuseExtras(const CLI::App& app) {
  std::vector<const CLI::App*> parsed = {&app};
  for (const CLI::App* command : app.get_subcommands()) parsed.push_back(command);
  std::vector<std::string> known;
  for (const CLI::Option* option : parsed.back()->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::string extra = app.remaining(true).empty() ? "" : app.remaining(true).front();
  std::string message = "'" + extra + "' is no argument of limn";
  if (parsed.size() > 1) {
    message += " " + parsed.back()->get_name();
  } else if (!extra.starts_with('-')) {
    known.clear();
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(command->get_name());
  }
  const std::string nearest = scene::nearestName(extra, known);
  throw UsageError(message + (nearest.empty() ? "; see limn --help" : "; did you mean " + nearest + "?"));
}

/// `--stats=$FILE` of an unset variable: the parser would take the next word for the value.
void refuseEmptyValues(int count, const char* const* arguments) {
  for (int k = 1; k < count; ++k) {
    const std::string_view word = arguments[k];
    if (word == "--") return;
    if (word == "-o=" || (word.size() > 3 && word.substr(0, 2) == "--" && word.find('=') == word.size() - 1))
      throw UsageError(std::string(word) + " has no value; write one after '='");
  }
}

}  // namespace

CommandLine readCommandLine(int count, const char* const* arguments) {
  CommandLine line;
  line.render.threads = line.coarsen.threads = availableThreads();
  CLI::App app("limn draws coarse triangle meshes with smooth silhouettes, on the CPU.", "limn");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", versionText);
  app.require_subcommand(1);
  const CLI::App* render = addRender(app, line.render);
  line.refine.threads = line.render.threads;
  const CLI::App* refine = addRefine(app, line.refine);
  CLI::App* info = app.add_subcommand("info", "what a model holds and what limn makes of it");
  addModel(*info, line.info.model);
  info->add_flag("--json", line.info.json, "for programs");
  CLI::App* compare = app.add_subcommand("compare", "exact comparison of two images");
  compare->add_option("A", line.compare.first, "a PNG file")->required()->type_name("");
  compare->add_option("B", line.compare.second, "another")->required()->type_name("");
  compare->add_option("-o,--output", line.compare.output, "write a picture of the differences")
      ->type_name("DIFF.png");
  CLI::App* verify =
      app.add_subcommand("verify", "frames of a run, cut into shards or not: all there, whole, of one job");
  verify->add_option("MANIFEST", line.verify.manifests, "files that `limn render --manifest` wrote")
      ->required()
      ->type_name("");
  line.verify.threads = line.render.threads;
  const CLI::App* coarsen = addCoarsen(app, line.coarsen);
  const CLI::App* models = app.add_subcommand("models", "the built-in models");
  app.footer(R"(`limn COMMAND --help` tells all about a command.

Examples:
  limn render -o demo.png
  limn render model.glb -o frames/%04d.png --turntable 36
  limn info model.glb
  limn compare a.png b.png -o difference.png
  limn coarsen fine.glb -o small.glb --triangles 500

Exit status: 0 done; 1 a fault of limn; 2 usage; 3 bad input; 4 output could not be
written; 5 images differ; 128+n ended by signal n.
)");

  refuseEmptyValues(count, arguments);
  try {
    app.parse(count, arguments);
  } catch (const CLI::CallForHelp&) {
    const auto commands = app.get_subcommands();
    std::cout << (commands.empty() ? app.help() : commands.front()->help("limn")) << std::flush;
    return line;
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << std::endl;
    return line;
  } catch (const CLI::ExtrasError&) {
    refuseExtras(app);
  } catch (const CLI::RequiredError& error) {
    if (!app.get_subcommands().empty()) throw UsageError(std::string(error.what()) + "; see limn --help");
    if (!app.remaining().empty()) refuseExtras(app);
    throw UsageError(
        "name a command: render, refine, info, compare, coarsen, verify or models; limn --help tells more");
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what(), name = text.substr(0, text.find(':'));
    throw UsageError(
        name + (text.find("At Most") != std::string::npos ? " is given more than once" : " needs a value") +
        "; see limn --help");
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  using Command = CommandLine::Command;
  if (render->parsed()) line.command = Command::kRender;
  if (refine->parsed()) line.command = Command::kRefine;
  if (info->parsed()) line.command = Command::kInfo;
  if (compare->parsed()) line.command = Command::kCompare;
  if (verify->parsed()) line.command = Command::kVerify;
  if (models->parsed()) line.command = Command::kModels;
  if (coarsen->parsed()) line.command = Command::kCoarsen;
  return line;
}

}  // namespace limn::program
