dataTable(document.getElementById("dataset-table"), JSON.parse(document.getElementById("dataset-data").textContent), 100);
