/**
 * Two descriptions side by side, with the difference of their pictures as a heat map.
 *
 * Input: the picture's state and a second description. Output: both pictures from the server, with the same scene, camera and size; and where
 * they differ. The difference is computed here, from the pixels of both.
 */
import { latest } from "./api.mjs";
import { count, element, fill, percent } from "./dom.mjs";
import { bitmapOf } from "./png.mjs";
import { uniformValues } from "./uniforms.mjs";

/**
 * @param {Record<"preset" | "own" | "first" | "second" | "difference" | "summary" | "grid", any>} elements
 * @param {object} options
 * @param {typeof import("./api.mjs").api} options.api
 * @param {{ key: string, title: string, text: string }[]} options.presets
 * @param {() => object} options.request the body of a request of the current picture
 * @param {(error: Error) => void} options.failed
 */
export function createCompare(elements, { api, presets, request, failed }) {
    const { preset, own, first, second, difference, summary, grid } = elements;
    let pinned = null;
    let visible = false;
    fill(
        preset,
        element("option", { value: "" }, "choose a second description"),
        presets.map(({ key, title }, index) =>
            element("option", { value: String(index) }, title && title !== key ? `${key} · ${title}` : key),
        ),
    );
    const run = latest(
        async (signal, left, right) => {
            const second = await ownValues(right, signal);
            const [one, two] = await Promise.all([left, second].map((body) => api.render(body, signal).then(pixels)));
            return [one, two];
        },
        {
            done([one, two]) {
                grid.classList.remove("outdated");
                draw(first, one);
                draw(second, two);
                const { heat, text } = compare(one, two);
                draw(difference, heat);
                summary.textContent = text;
            },
            failed(error) {
                grid.classList.remove("outdated");
                summary.textContent = error.message;
                failed(error);
            },
        },
    );
    // k and the uniforms are those of the first description: the second has its own, with the values of equal names.
    const ownValues = async (body, signal) => {
        const { description } = await api.analyse({ text: body.text }, signal);
        if (!description) throw new Error("The second description has errors: choose another one.");
        return { ...body, k: null, uniforms: uniformValues(description.uniforms, body.uniforms) };
    };
    const secondText = () => (preset.value === "" ? pinned : presets[Number(preset.value)].text);
    const update = () => {
        const text = secondText();
        grid.hidden = text === null;
        if (!visible || text === null) return;
        const body = request();
        grid.classList.add("outdated");
        summary.textContent = "Rendering both …";
        run(body, { ...body, text });
    };
    preset.addEventListener("change", update);
    own.addEventListener("click", () => {
        pinned = request().text;
        preset.value = "";
        preset.options[0].textContent = "the description as it was kept";
        update();
    });
    return {
        update,
        setVisible(is) {
            visible = is;
            update();
        },
    };
}

/** Returns the pixels of a rendered picture. */
async function pixels({ png }) {
    const bitmap = await bitmapOf(png);
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
    return context.getImageData(0, 0, canvas.width, canvas.height);
}

function draw(canvas, image) {
    [canvas.width, canvas.height] = [image.width, image.height];
    canvas.getContext("2d").putImageData(image, 0, 0);
}

/**
 * Returns where two pictures of one size differ, from black over red and yellow to white, and how much in words. A difference is the largest
 * of the channels; the map's white is the largest difference of the picture.
 * @param {ImageData} one @param {ImageData} two
 */
export function compare(one, two) {
    const { width, height } = one;
    const differences = new Uint8Array(width * height);
    let most = 0;
    let total = 0;
    let different = 0;
    for (let pixel = 0; pixel < differences.length; pixel += 1) {
        let largest = 0;
        for (let channel = 0; channel < 4; channel += 1) {
            const at = 4 * pixel + channel;
            largest = Math.max(largest, Math.abs(one.data[at] - two.data[at]));
        }
        differences[pixel] = largest;
        most = Math.max(most, largest);
        total += largest;
        // A channel that is rounded differently is no difference.
        if (largest > 1) different += 1;
    }
    const heat = new ImageData(width, height);
    differences.forEach((value, pixel) => heat.data.set(heatColor(most > 0 ? value / Math.max(most, 8) : 0), 4 * pixel));
    const mean = (total / Math.max(differences.length, 1)).toPrecision(3);
    const text =
        different === 0
            ? `No pixel differs by more than 1 of 255.`
            : `${count(different)} pixels (${percent(different, differences.length)}) differ by more than 1 of 255; at most ${most} of 255, ${Number(mean)} on average.`;
    return { heat, text, most, different };
}

function heatColor(part) {
    const channel = (from) => Math.round(255 * Math.min(Math.max(3 * part - from, 0), 1));
    return [channel(0), channel(1), channel(2), 255];
}
