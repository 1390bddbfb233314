#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "render/cost/study.h"

// Results that nobody measured.
namespace likeness::scene_cost::test {

inline Row row(const Levels& levels, double ms, double flip, double spread = 0.1) {
  Row out;
  out.levels = levels;
  for (const double part : {-spread, 0.0, spread}) {
    Row::Reading r;
    r.wall_ms = ms * (1 + part), r.cpu_ms = 2 * ms * (1 + part);
    out.readings.push_back(r);
  }
  out.errors = {flip * flip, flip, flip, 2 * flip};
  out.predicted_wall_ms = ms, out.predicted_cpu_ms = 2.1 * ms;
  out.shown_png = out.map_png = "png";
  return out;
}

// Four combinations, of which the third is beaten by the second, and the path tracer.
inline Study toy_study() {
  Study s;
  s.machine = {"Processor <&>", 2};
  s.scene = "a \"room\" & <script>alert(1)</script>", s.camera = "left,\nright", s.view = "srgb";
  s.width = 8, s.height = 4;
  s.matters[0] = s.matters[1] = true;
  s.rows = {row({0, 0, 0}, 1, 0.4), row({1, 0, 0}, 4, 0.2), row({0, 2, 0}, 10, 0.3), row({1, 2, 0}, 40, 0.1)};
  s.rows[3].in_ladder[0] = s.rows[3].in_ladder[1] = s.rows[2].in_ladder[0] = s.rows[1].in_ladder[1] = true;
  s.rows.push_back(row({0, 0, 0}, 2, 0.05));
  s.rows.back().is_path_tracer = true, s.rows.back().samples = 4;
  s.best = {1, 2, 0};
  s.reference.source = "path tracer";
  s.reference.noise = Errors{1e-4, 0.01, 0.01, 0.02};
  s.direct_only = Errors{0.01, 0.09, 0.1, 0.2};
  s.reference_png = s.direct_png = s.direct_map_png = "png";
  s.is_complete = true;
  return s;
}

}  // namespace likeness::scene_cost::test
