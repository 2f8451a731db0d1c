// Pictures: sRGB and alpha, a byte each.

// The beginning of Alice's Adventures in Wonderland (Lewis Carroll, 1865; public domain).

const TEXT = `Alice was beginning to get very tired of sitting by her sister on the bank, and of having nothing to do: once or
twice she had peeped into the book her sister was reading, but it had no pictures or conversations in it, “and what is
the use of a book,” thought Alice “without pictures or conversations?” So she was considering in her own mind (as well as
she could, for the hot day made her feel very sleepy and stupid), whether the pleasure of making a daisy-chain would be
worth the trouble of getting up and picking the daisies, when suddenly a White Rabbit with pink eyes ran close by her.
There was nothing so very remarkable in that; nor did Alice think it so very much out of the way to hear the Rabbit say to
itself, “Oh dear! Oh dear! I shall be late!” (when she thought it over afterwards, it occurred to her that she ought to
have wondered at this, but at the time it all seemed quite natural); but when the Rabbit actually took a watch out of its
waistcoat-pocket, and looked at it, and then hurried on, Alice started to her feet, for it flashed across her mind that
she had never before seen a rabbit with either a waistcoat-pocket, or a watch to take out of it, and burning with
curiosity, she ran across the field after it, and fortunately was just in time to see it pop down a large rabbit-hole
under the hedge. In another moment down went Alice after it, never once considering how in the world she was to get out
again. The rabbit-hole went straight on like a tunnel for some way, and then dipped suddenly down, so suddenly that Alice
had not a moment to think about stopping herself before she found herself falling down a very deep well.`;

// A page of text.
export function draw_text_page([width, height]) {
    const surface = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    surface.fillStyle = "#f4efe4";
    surface.fillRect(0, 0, width, height);
    surface.fillStyle = "#1c1a17";
    // As large as the page holds it.
    const font_px = Math.max(8, Math.sqrt((width * height) / 1330));
    const [left, line_px] = [0.05 * width, 1.36 * font_px];
    surface.font = `600 ${1.5 * font_px}px Georgia, serif`;
    let y = 3.2 * font_px;
    surface.fillText("Down the Rabbit-Hole", left, y);
    surface.font = `${font_px}px Georgia, serif`;
    y += 1.7 * line_px;
    let line = "";
    for (const word of TEXT.split(/\s+/)) {
        if (surface.measureText(`${line} ${word}`).width > width - 2 * left) {
            surface.fillText(line, left, y);
            [line, y] = ["", y + line_px];
        }
        line += line ? ` ${word}` : word;
    }
    surface.fillText(line, left, y);
    return new Uint8Array(surface.getImageData(0, 0, width, height).data.buffer);
}

function drawn(image, size, scale) {
    const surface = new OffscreenCanvas(...size).getContext("2d", { willReadFrequently: true });
    surface.fillStyle = "#16171a";
    surface.fillRect(0, 0, ...size);
    surface.imageSmoothingQuality = "high";
    const [width, height] = [image.width * scale, image.height * scale];
    const box = [(size[0] - width) / 2, (size[1] - height) / 2, width, height];
    // Under what is transparent.
    surface.fillStyle = "#fff";
    surface.fillRect(...box);
    surface.drawImage(image, ...box);
    return new Uint8Array(surface.getImageData(0, 0, ...size).data.buffer);
}

// A picture that fills the frame; what does not fit is cut.
export const filling = (image, size) => drawn(image, size, Math.max(size[0] / image.width, size[1] / image.height));

// A whole picture in the frame, between bars.
export const letterboxed = (image, size) => drawn(image, size, Math.min(size[0] / image.width, size[1] / image.height));
