#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>

#include "render/command/integrators.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::render_command {
namespace {

constexpr double kPreviewSeconds = 3;
constexpr std::uint32_t kMostLightSamples = 64;  // of the layers of each light

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

reference::Film film_of(const Job& job, const scene::Camera& camera) {
  if (job.state.empty()) return {camera.width, camera.height, job.options.has_layers};
  const std::string name = job.state.string();
  reference::Film film = reference::Film::of_state(image::read_layers(job.state), job.key, name);
  if (film.width() != camera.width || film.height() != camera.height || film.has_layers() != job.options.has_layers)
    throw files::InputError(name + ": the state of a picture of another size (delete it to start anew)");
  return film;
}

// The progress line, told by whichever thread has just finished a tile.
class Teller {
 public:
  Teller(std::uint32_t samples, double share) : samples_(samples), first_share_(share), share_(share) {}

  void at_end_of_pass(const reference::Progress& p, double now) {
    const std::scoped_lock lock(mutex_);
    samples_ = p.samples, share_ = p.share, told_at_ = now;
    tell(share_);
  }
  // Between passes nothing but the time says how far it is.
  void within_pass(double now) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const double gained = told_at_ > 0 ? (share_ - first_share_) * (now / told_at_ - 1) : 0;
    tell(std::min(share_ + gained, 0.99));
  }

 private:
  void tell(double share) {
    const double rest = 1 - first_share_;
    line_.tell(std::to_string(samples_) + (samples_ == 1 ? " sample" : " samples") + " a pixel",
               rest > 0 ? std::max(share - first_share_, 0.0) / rest : 0);
  }

  std::mutex mutex_;
  files::Progress line_;
  std::uint32_t samples_;
  double first_share_, share_, told_at_ = 0;
};

// Lights may have very long names, and then the same; layers may not.
void make_names_unique(image::Layers& layers) {
  constexpr std::size_t kLongest = 180;
  std::set<std::string> seen;
  for (image::Layer& layer : layers.layers) {
    layer.name = layer.name.substr(0, kLongest);
    const std::string name = layer.name;
    for (int i = 2; !seen.insert(layer.name).second; ++i) layer.name = name + "_" + std::to_string(i);
  }
}

}  // namespace

Rendered render_reference(const Job& job) {
  const scene::Camera& camera = job.world.scene.cameras[job.options.camera];
  auto film = std::make_shared<reference::Film>(film_of(job, camera));
  Rendered out;
  out.samples_before = film->least_samples();

  const bool counts_samples_only = !(job.options.seconds > 0) && !(job.options.relative_error > 0);
  const double start = seconds_now();
  double previewed_at = start;
  {
    Teller teller(out.samples_before, counts_samples_only ? double(out.samples_before) / job.options.samples : 0);
    // A stop changes nothing of the picture: a preview stops the render, so that no thread writes what is shown.
    for (;;) {
      std::atomic<bool> wants_preview = false;
      bool is_done = false;
      reference::Options options = job.options;
      if (options.seconds > 0) options.seconds = std::max(options.seconds - (seconds_now() - start), 1e-6);
      reference::render(job.world, options, *film, [&](const reference::Progress& p) {
        if (files::interrupted()) return false;
        const double now = seconds_now();
        if (p.share >= 0) teller.at_end_of_pass(p, now - start);
        else teller.within_pass(now - start);
        if (p.share >= 1) is_done = true;
        else if (job.preview && now - previewed_at > kPreviewSeconds) wants_preview = true;
        return !wants_preview;
      });
      if (!wants_preview || is_done || files::interrupted()) break;
      job.preview(film->picture());
      previewed_at = seconds_now();
    }
  }

  out.is_interrupted = files::interrupted() && film->least_samples() < job.options.samples;
  out.samples = film->least_samples();
  out.relative_error = film->relative_error();
  out.rejected = film->rejected();
  out.layers = film->layers();
  if (out.is_interrupted) {
    out.state = [film](const std::string& key) { return film->state(key); };
  } else if (job.has_light_layers) {
    reference::Options options = job.options;
    options.samples = std::min(std::max(out.samples, 1u), kMostLightSamples);
    reference::add_light_layers(job.world, options, out.layers);
    make_names_unique(out.layers);
  }
  return out;
}

}  // namespace likeness::render_command
