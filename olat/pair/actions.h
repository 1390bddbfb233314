#pragma once

#include <array>
#include <string_view>

// What a key does in the viewer. The only list: the page's help and palette, docs/olat_view.md and the tests are made
// from it, and each id names a function of olat/viewer/actions.js.
namespace likeness::olat_pair {

struct Action {
  std::string_view id, group;
  std::string_view keys;  // alternatives with a space between: [Ctrl+][Shift+]KEY, as the browser names it
  std::string_view text;
};

inline constexpr std::array kActions{
    Action{"light_previous", "Where", "ArrowLeft j", "Previous light"},
    Action{"light_next", "Where", "ArrowRight l", "Next light"},
    Action{"light_back_10", "Where", "Shift+ArrowLeft Shift+j", "Ten lights back"},
    Action{"light_on_10", "Where", "Shift+ArrowRight Shift+l", "Ten lights on"},
    Action{"light_first", "Where", "Home", "First light"},
    Action{"light_last", "Where", "End", "Last light"},
    Action{"camera_previous", "Where", "ArrowUp i", "Previous camera"},
    Action{"camera_next", "Where", "ArrowDown k", "Next camera"},
    Action{"variant_next", "Where", "Shift+q", "Next set of renders"},
    Action{"worst", "Where", "h", "Worst pair that is not seen yet"},

    Action{"flip", "What", "Space t", "Flip between photo and render"},
    Action{"hold", "What", "Enter", "The other picture, as long as the key is held"},
    Action{"auto_flip", "What", "Shift+t", "Flip by itself, once a second; again: stop"},
    Action{"wipe", "What", "w", "Wipe"},
    Action{"side", "What", "s", "Side by side"},
    Action{"onion", "What", "o", "Onion: both, mixed"},
    Action{"difference", "What", "d", "Difference by the metric"},
    Action{"split_less", "What", ",", "Split, or mix, to the left"},
    Action{"split_more", "What", ".", "Split, or mix, to the right"},
    Action{"metric_next", "What", "m", "Next metric"},
    Action{"metric_previous", "What", "Shift+m", "Previous metric"},

    Action{"ev_up_half", "Light", "e", "Exposure half a stop up"},
    Action{"ev_down_half", "Light", "Shift+e", "Exposure half a stop down"},
    Action{"ev_up_quarter", "Light", "]", "Exposure a quarter up"},
    Action{"ev_down_quarter", "Light", "[", "Exposure a quarter down"},
    Action{"ev_up", "Light", "}", "Exposure a stop up"},
    Action{"ev_down", "Light", "{", "Exposure a stop down"},
    Action{"ev_job", "Light", "0", "Exposure of the capture"},
    Action{"ev_percentile", "Light", "Shift+n", "Exposure that puts the photo's 99th percentile on white"},
    Action{"ev_auto", "Light", "n", "Exposure that puts the photo's log average on middle grey"},
    Action{"match_next", "Light", "q", "Next match gain"},
    Action{"view_next", "Light", "v", "Next view"},
    Action{"view_previous", "Light", "Shift+v", "Previous view"},

    Action{"zones", "Overlay", "z", "Zones of one stop, colored"},
    Action{"wedge", "Overlay", "Shift+z", "Wedge of 17 greys"},
    Action{"curve", "Overlay", "x", "Toe, line and shoulder of the view"},
    Action{"zebra", "Overlay", "u", "Stripes where display or sensor is full"},
    Action{"red", "Channel", "r", "Red light"},
    Action{"green", "Channel", "g", "Green light"},
    Action{"blue", "Channel", "b", "Blue light"},
    Action{"luma", "Channel", "y", "Luminance"},
    Action{"coverage", "Channel", "a", "Mask"},
    Action{"signed", "Channel", "Shift+y", "Luminance with its sign: blue below 0, orange above"},
    Action{"color", "Channel", "c", "Color"},

    Action{"fit", "Window", "f", "All of the picture"},
    Action{"one_to_one", "Window", "Ctrl+0", "One pixel for one"},
    Action{"zoom_in", "Window", "+ =", "Closer"},
    Action{"zoom_out", "Window", "-", "Farther"},
    Action{"pin", "Window", "p", "Pin the probe where the pointer is; again: let go"},
    Action{"region", "Window", "Shift+r", "Measure a region: arrows move it, Shift arrows size it"},
    Action{"region_copy", "Window", "Shift+x", "Copy the numbers of the region"},
    Action{"bookmark_recall", "Window", "1 2 3 4 5 6 7 8 9", "Go to a bookmark"},
    Action{"bookmark_store", "Window", "Ctrl+1 Ctrl+2 Ctrl+3 Ctrl+4 Ctrl+5 Ctrl+6 Ctrl+7 Ctrl+8 Ctrl+9",
           "Keep this state as a bookmark"},
    Action{"copy_command", "Window", "Shift+c", "Copy the command line of this picture"},
    Action{"save_view", "Window", "Shift+s", "Save the state as view.json"},
    Action{"panels", "Window", "\\", "Hide or show the panels"},
    Action{"help", "Window", "?", "Keys"},
    Action{"palette", "Window", "Ctrl+Shift+p", "Find an action by its name"},
    Action{"close", "Window", "Escape", "Close what is open"},
};

}  // namespace likeness::olat_pair
