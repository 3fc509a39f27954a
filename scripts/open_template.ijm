// Opens template.tif of a result in Fiji or ImageJ, calibrated in nm, and shows it projected along z with a
// scale bar. Plugins > Macros > Run..., or: ImageJ -macro scripts/open_template.ijm RESULT_DIRECTORY
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
bar = 1;
while (bar * 5 < columns * width) bar = bar * 2;
run("Scale Bar...", "width=" + bar / 2 + " height=4 color=White background=None location=[Lower Right] overlay");
