//! The explorer of the atlas: one asks for one's own images, and is told what to take.

use crate::markup::json;

/// How its element begins.
pub(super) const MARK: &str = "<div class=\"explorer\">";

/// What the script makes the explorer of; without it, where the same is to be read.
pub(crate) fn body(data: &serde_json::Value) -> String {
    format!(
        "{MARK}<p class=\"still\">With JavaScript this section asks for blur, noise, tilt, size or room and the speed that is needed. \
         Without it <a href=\"#atlas-which-operator\">the tables</a> say the same.</p><script type=\"application/json\" class=\"explorer-data\">{}</script></div>\n",
        json(data)
    )
}
