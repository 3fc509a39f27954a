// Opens template.tif of a result in Fiji or ImageJ, calibrated in nm, and shows it projected along z with a
// scale bar; the channels of a composite keep their colours. Plugins > Macros > Run..., or:
// ImageJ -macro scripts/open_template.ijm RESULT_DIRECTORY
folder = getArgument();
if (folder == "") folder = getDirectory("A result of polar run (polar export --to tiff)");
if (!endsWith(folder, File.separator)) folder = folder + File.separator;
if (!File.exists(folder + "template.tif")) exit("no template.tif in " + folder + ": polar export RESULT --to tiff");
open(folder + "template.tif");
getVoxelSize(width, height, depth, unit);
getDimensions(columns, rows, channels, slices, frames);
print("template.tif: " + columns + " x " + rows + " x " + slices + " voxels of " + width + " " + unit + ", channels: " + channels);
if (slices > 1) run("Z Project...", "projection=[Max Intensity]");
if (channels == 1) run("Fire");
run("Enhance Contrast", "saturated=0.1");
// The longest of 1, 2, 5, 10, ... that is no longer than a third of the picture.
bar = 1;
next = 2;
while (next * 3 <= columns * width) {
  bar = next;
  if (startsWith("" + bar, "2")) next = bar / 2 * 5; else next = bar * 2;
}
zoom = 100 * maxOf(1, floor(400 / columns));
run("Set... ", "zoom=" + zoom);
run("Scale Bar...", "width=" + bar + " height=" + maxOf(1, floor(columns / 70)) + " font=" + maxOf(6, floor(columns / 9))
    + " color=White background=None location=[Lower Right] bold overlay");
