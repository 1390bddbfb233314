#include "olat/view/command.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "olat/tev/listener.h"
#include "olat/tev/send.h"
#include "olat/view/report.h"
#include "olat/view/server.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"

namespace likeness::olat_view {
namespace {

struct Request {
  std::string capture, state, out = "picture.png";
  int port = 0;
  double cache_mb = 1024;
  bool no_scores = false, json = false;
  std::optional<std::string> tev;  // address; "": the usual one
};

// --NAME with an address after it, or without: the usual one.
void add_address(CLI::App& app, const std::string& name, std::optional<std::string>& to, std::string_view usual,
                 const std::string& text) {
  app.add_option_function<std::vector<std::string>>(
         name, [&to](const std::vector<std::string>& words) { to = words.empty() ? "" : words[0]; },
         text + "; without HOST:PORT " + std::string(usual))
      ->type_name("[HOST:PORT]")
      ->expected(0, 1);
}

// A state's text, or of @FILE what is in it.
std::string state_text(const std::string& text) {
  constexpr std::size_t kMostBytes = 1 << 16;
  return text.starts_with('@') ? files::read_whole(text.substr(1), kMostBytes) : text;
}

int view(const Request& request) {
  const std::string wanted = state_text(request.state);
  const olat_pair::State state = olat_pair::state_of(wanted);
  capture::Capture capture = capture::read_capture(request.capture);
  olat_pair::place_of(capture, state);
  ViewOptions options;
  olat_tev::Images received;
  std::unique_ptr<olat_tev::Listener> tev;
  if (request.tev) {
    tev =
        std::make_unique<olat_tev::Listener>(received, request.tev->empty() ? olat_tev::kListenAddress : *request.tev);
    options.received = &received;
  }
  options.cache_bytes = static_cast<std::size_t>(request.cache_mb * 1e6);
  options.with_scores = !request.no_scores;
  Answers answers(std::move(capture), options);
  Server server(answers, request.port);
  std::string text = olat_pair::text_of(state);
  // An address without an exposure is opened with one for its photo.
  if (state.ev == 0 && olat_pair::has_field(wanted, "ev")) text += text.empty() ? "ev=0" : "&ev=0";
  const std::string address = server.address(text);
  if (request.json)
    std::cout << "{\"address\": \"" << address << "\", \"port\": " << server.port()
              << (tev ? ", \"tev_port\": " + std::to_string(tev->port()) : "") << "}" << std::endl;
  else
    std::cout << address << "\nOpen it in a browser; Ctrl-C ends."
              << (tev ? "\nRenderers that know tev may send to 127.0.0.1:" + std::to_string(tev->port()) : "")
              << std::endl;

  files::catch_interrupts();
  std::thread listener([&] { server.run(); });
  while (!files::interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  listener.join();
  return 0;
}

// SET/CAMERA/LIGHT: the sets beside one another in tev's list, and pairs again where Likeness receives them.
int send_pair(const Request& request, const capture::Capture& capture, const olat_pair::State& state,
              const olat_pair::Pair& pair) {
  const olat_pair::Place place = olat_pair::place_of(capture, state);
  const std::string at = "/" + capture.cameras[place.camera].id + "/" + capture.lights[place.light].id;
  const std::string address(request.tev->empty() ? olat_tev::kTevAddress : *request.tev);
  olat_tev::Sender sender(address);
  std::string names;
  const auto send = [&](const std::string& set, const image::Picture& light) {
    if (light.width == 0) return;
    sender.send(set + at, light);
    names += std::string(names.empty() ? "" : ", ") + (request.json ? '"' + set + at + '"' : set + at);
  };
  send("photo", pair.photo);
  image::Picture render = pair.render;
  for (std::size_t i = 0; i < render.rgb.size(); ++i) render.rgb[i] *= pair.gain[i % 3];
  if (place.variant != capture::kAbsent) send(capture.variants[place.variant].id, render);
  if (request.json) std::cout << "{\"tev\": \"" << address << "\", \"sent\": [" << names << "]}\n";
  else std::cout << "sent to " << address << ": " << names << "\n";
  return 0;
}

int picture(const Request& request) {
  const olat_pair::State state = olat_pair::state_of(state_text(request.state));
  const capture::Capture capture = capture::read_capture(request.capture);
  const olat_pair::Pair pair = olat_pair::load_pair(capture, state);
  if (pair.width() == 0)
    throw files::InputError(request.capture + ": neither photo nor render of this camera and light");
  if (request.tev) return send_pair(request, capture, state, pair);
  const image::DisplayPicture out = olat_pair::picture_of(state, pair);
  image::write_png(request.out, out);
  const std::string pipeline = olat_pair::pipeline_of(state);
  if (request.json)
    std::cout << "{\"out\": \"" << request.out << "\", \"width\": " << out.width << ", \"height\": " << out.height
              << ", \"state\": \"" << olat_pair::text_of(state) << "\", \"pipeline\": \"" << pipeline
              << "\", \"hash\": \"" << olat_pair::hash_of(pipeline) << "\"}\n";
  else
    std::cout << "written: " << request.out << " (" << out.width << " x " << out.height << ", pipeline "
              << olat_pair::hash_of(pipeline) << ")\n";
  return 0;
}

int report(const std::string& folder, const ReportOptions& options, const std::string& out, bool json) {
  const capture::Capture capture = capture::read_capture(folder);
  files::catch_interrupts();
  const ReportSummary summary = write_report(capture, options, out);
  if (json)
    std::cout << "{\"out\": \"" << out << "\", \"compared\": " << summary.compared << ", \"held\": " << summary.held
              << ", \"bytes\": " << summary.bytes << "}\n";
  else
    std::cout << "written: " << out << " (" << summary.compared << " pairs compared, the worst " << summary.held
              << " in it, " << (summary.bytes + 999'999) / 1'000'000 << " MB)\n";
  return 0;
}

std::string keys_of_states() {
  std::string out = "A state is key=value&key=value, the query of the viewer's address:\n";
  for (const olat_pair::Field& field : olat_pair::fields()) {
    std::string words;
    for (const olat_pair::Choice& c : field.choices) words += (words.empty() ? ": " : ", ") + std::string(c.word);
    for (const std::string_view name : field.names) words += (words.empty() ? ": " : ", ") + std::string(name);
    std::string name(field.name);
    name.resize(std::max<std::size_t>(name.size(), 9), ' ');
    out += "  " + name + std::string(field.text) + words + "\n";
  }
  return out;
}

}  // namespace

void add_view(CLI::App& olat, int& exit_code) {
  const auto request = std::make_shared<Request>();
  CLI::App* app = olat.add_subcommand("view", "A page on which a capture and its renders are compared");
  app->add_option("CAPTURE", request->capture, "Folder with capture.json")->required();
  app->add_option("--state", request->state, "What is shown first: a state's text, or @view.json");
  app->add_option("--port", request->port, "On 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app->add_option("--cache-mb", request->cache_mb, "Memory for decoded pictures [MB]")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  app->add_flag("--no-scores", request->no_scores, "Do not compare all pairs in the background");
  add_address(*app, "--tev-listen", request->tev, olat_tev::kListenAddress,
              "Show what renderers send by tev's protocol as further renders");
  app->add_flag("--json", request->json, "Print address and port as JSON");
  app->footer(
      "Photo and render pass one exposure, one view and one display curve, and are flipped, wiped, mixed or "
      "subtracted\n"
      "by a key (? lists them). The page is served to this machine only, and needs the token of the printed address; "
      "from\n"
      "elsewhere: ssh -L 8080:127.0.0.1:8080 HOST, and --port 8080 there. The capture is only read.\n"
      "\n"
      "  likeness olat view captures/cat\n"
      "  likeness olat view captures/cat --state 'light=012&mode=wipe&view=agx'\n"
      "  likeness olat view captures/cat --tev-listen                    pbrt ... --display-server 127.0.0.1:14159\n"
      "\n"
      "Exit codes: 0 ended by Ctrl-C, 2 usage, 3 a file cannot be used. Manual: docs/olat_view.md");
  app->callback([request, &exit_code] { exit_code = view(*request); });

  app = olat.add_subcommand("picture", "The picture of a state of the viewer, made without a browser");
  app->add_option("CAPTURE", request->capture, "Folder with capture.json")->required();
  app->add_option("--state", request->state, "A state's text, or @view.json");
  app->add_option("--out", request->out, "PNG to write")->capture_default_str();
  add_address(*app, "--tev", request->tev, olat_tev::kTevAddress,
              "Instead of a PNG, send light of photo and render (with its match gain) to a running tev");
  app->add_flag("--json", request->json, "Print what was written as JSON");
  app->footer(keys_of_states() +
              "\n"
              "  likeness olat picture captures/cat --state 'light=012&mode=difference&metric=stops' --out stops.png\n"
              "  likeness olat picture captures/cat --state light=012 --tev\n"
              "\n"
              "Exit codes: 0 done, 2 usage, 3 a file cannot be used. Manual: docs/olat_view.md");
  app->callback([request, &exit_code] { exit_code = picture(*request); });

  struct ReportRequest {
    std::string capture, out = "report.html";
    ReportOptions options;
    bool json = false;
  };
  const auto wanted = std::make_shared<ReportRequest>();
  app = olat.add_subcommand("report", "One page to mail: every pair compared, the worst with their light");
  app->add_option("CAPTURE", wanted->capture, "Folder with capture.json")->required();
  app->add_option("--out", wanted->out, "Page to write")->capture_default_str();
  app->add_option("--variant", wanted->options.variant, "Renders to compare with; the first");
  app->add_option("--metric", wanted->options.metric, "Of light: stops, signed, absolute, smape or hdr_flip")
      ->capture_default_str();
  app->add_option("--pairs", wanted->options.pairs, "The page holds, the worst ones")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app->add_option("--side", wanted->options.side, "Of their crops around the largest error [pixel]")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app->add_flag("--json", wanted->json, "Print what was written as JSON");
  app->footer(
      "The page needs no network and opens from a file; exposure, view, flip, wipe and difference work as in the "
      "viewer.\n"
      "\n"
      "  likeness olat report captures/cat --out cat.html\n"
      "\n"
      "Exit codes: 0 done, 2 usage, 3 a file cannot be used. Manual: docs/olat_view.md");
  app->callback(
      [wanted, &exit_code] { exit_code = report(wanted->capture, wanted->options, wanted->out, wanted->json); });
}

}  // namespace likeness::olat_view
