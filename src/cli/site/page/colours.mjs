/**
 * Light and dark on pages without the player: the button of the playground, which is hidden where scripts do not run.
 */
import { createTheme } from "./play/theme.mjs";

const button = document.getElementById("theme");
if (button) {
    button.hidden = false;
    createTheme(button);
}
