/**
 * Light and dark: as the system says, or as the person chose on this page.
 *
 * Input: clicks. Output: the attribute `data-theme` of the page, which base.css reads. The choice is kept in the browser's storage, where
 * there is one.
 */

const STORED = "fragbuf-theme";
const NEXT = { system: "light", light: "dark", dark: "system" };
const NAMES = { system: "as the system", light: "light", dark: "dark" };

/** Makes a button change the colours: system, light, dark. */
export function createTheme(button) {
    let theme = read();
    const show = () => {
        document.documentElement.dataset.theme = theme;
        button.setAttribute("aria-label", `Colours: ${NAMES[theme]}`);
        button.title = `Colours: ${NAMES[theme]}. Click for ${NAMES[NEXT[theme]]}.`;
        button.dataset.theme = theme;
    };
    button.addEventListener("click", () => {
        theme = NEXT[theme];
        write(theme);
        show();
    });
    show();
}

function read() {
    try {
        const stored = localStorage.getItem(STORED);
        return stored && stored in NEXT ? stored : "system";
    } catch {
        // A browser may forbid the storage.
        return "system";
    }
}

function write(theme) {
    try {
        localStorage.setItem(STORED, theme);
    } catch {
        // The choice lasts as long as the page.
    }
}
